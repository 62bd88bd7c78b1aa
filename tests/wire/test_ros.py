"""The example ROS node for teams (firmware/doors/intake/clients): its conversion of Python messages of ROS 1 and ROS 2, and the node
itself on Debian's ROS 1, with the real programs."""

import array
import importlib.util
import os
import pathlib
import signal
import struct
import sys
import threading
import types
import unittest

import messages
import programs
from delivered import Delivered
from programs import Stage, wait_until

SHOWN = pathlib.Path(os.environ["ADIT_SOURCE"]) / "firmware/doors/intake/clients"
sys.path.append(str(SHOWN))
sys.dont_write_bytecode = True
from ros_messages import Robot  # noqa: E402
from ros_node import MOST, Outbox  # noqa: E402

SECONDS, NANOSECONDS = 1700000000, 500_000_000
CELLS = (0, 100, -1, 50, 0, -1)
POINTS = struct.pack("<3f4x3f4x", 1.5, -2, 0.25, 4, 5, -0.0)
POSE = {"position": {"x": 1.5, "y": -2.0, "z": 0.0}, "orientation": {"x": 0.0, "y": 0.0, "z": 0.6, "w": 0.8}}
FIELDS = [{"name": name, "offset": 4 * at, "datatype": 7, "count": 1} for at, name in enumerate("xyz")]
LIFETIME = 3000  # seconds
MARKER = {"ns": "finds", "id": 3, "type": 2, "action": 0, "pose": POSE, "scale": dict.fromkeys("xyz", 0.5),
          "color": {"r": 1.0, "g": 0.5, "b": 0.25, "a": 1.0}, "text": "Backpack"}


def ros_1(members):
    """A message as genpy makes it, with its members in __slots__."""
    return type("Message", (), {"__slots__": list(members)}), {}


def ros_2(members):
    """A message as rosidl makes it: members are properties, and a function returns their names."""
    made = {name: property(lambda self, name=name: getattr(self, "_" + name)) for name in members}
    made["__slots__"] = ["_" + name for name in members] + ["_check_fields"]
    made["get_fields_and_field_types"] = classmethod(lambda cls: dict.fromkeys(members, ""))
    return type("Message", (), made), {"_": True}


def message(version, **members):
    kind, behind = version(members)
    made = kind()
    for name, value in members.items():
        setattr(made, ("_" if behind else "") + name, value)
    return made


def deep(version, value):
    if isinstance(value, dict):
        return message(version, **{name: deep(version, each) for name, each in value.items()})
    return [deep(version, each) for each in value] if isinstance(value, list) else value


def times(version):
    return ("secs", "nsecs") if version is ros_1 else ("sec", "nanosec")


def header(version, frame="map"):
    more = {"seq": 7} if version is ros_1 else {}
    stamp = message(version, **dict(zip(times(version), (SECONDS, NANOSECONDS), strict=True)))
    return message(version, **more, stamp=stamp, frame_id=frame)


def grid(version, frame="map"):
    cells = CELLS if version is ros_1 else array.array("b", CELLS)
    info = {"resolution": 0.25, "width": 3, "height": 2, "origin": POSE}
    return message(version, header=header(version, frame), info=deep(version, info), data=cells)


def cloud(version):
    data = POINTS if version is ros_1 else array.array("B", POINTS)
    return message(version, header=header(version), height=1, width=2, fields=deep(version, FIELDS), is_bigendian=False,
                   point_step=16, row_step=32, data=data, is_dense=True)


def odometry(version):
    pose = message(version, pose=deep(version, POSE), covariance=[0.0] * 36)
    return message(version, header=header(version), child_frame_id="base", pose=pose)


def marker(version, frame="map", **changes):
    lifetime = message(version, **dict(zip(times(version), (LIFETIME, 0), strict=True)))
    said = {name: deep(version, value) for name, value in {**MARKER, **changes}.items()}
    return message(version, header=header(version, frame), **said, lifetime=lifetime,
                   frame_locked=False, points=[], colors=[], mesh_resource="", mesh_use_embedded_materials=False)


ROBOT = Robot("husky", "map")


class Messages(Delivered):
    """The messages as the Command Post receives them."""

    def sent(self, made):
        what, content = made
        return self.deliver(f"/{what}/update", content, messages.Style())

    def test_grids(self):
        for version in (ros_1, ros_2):
            arrived = self.sent(ROBOT.map(grid(version)))
            cells = bytes(cell & 0xFF for cell in CELLS)
            self.same_map(arrived, {"type": "OccupancyGrid", "name": "husky"}, cells,
                          {"info": {"resolution": 0.25, "width": 3, "height": 2, "origin": POSE}})

    def test_clouds(self):
        for version in (ros_1, ros_2):
            self.same_map(self.sent(ROBOT.map(cloud(version))), {"type": "PointCloud2", "name": "husky"}, POINTS,
                          {"fields": FIELDS, "is_bigendian": False, "point_step": 16})

    def test_odometry(self):
        for version in (ros_1, ros_2):
            arrived = self.sent(ROBOT.state(odometry(version)))
            self.assertEqual(arrived["poses"], [{"name": "husky", **POSE}])

    def test_markers(self):
        for version in (ros_1, ros_2):
            (arrived,) = self.sent(ROBOT.markers(types.SimpleNamespace(markers=[marker(version)])))["markers"]
            self.assertEqual({name: arrived[name] for name in MARKER}, MARKER)
            self.assertTrue(LIFETIME - 100 < arrived["lifetime"] <= LIFETIME, "less the time in the queue")


class Frames(unittest.TestCase):
    def test_messages_of_another_frame_are_logged_and_not_sent(self):
        for version in (ros_1, ros_2):
            with self.assertLogs("rosout.adit") as said:
                self.assertFalse(ROBOT.fits(grid(version, "odom")))
            self.assertIn("expected frame map, got odom", said.output[0])
            with self.assertLogs("rosout.adit"):
                one_of_two = types.SimpleNamespace(markers=[marker(version, "odom"), marker(version, "/map")])
                self.assertTrue(ROBOT.keep_fitting(one_of_two))
                self.assertEqual(len(ROBOT.markers(one_of_two)[1]["markers"]), 1)
                self.assertFalse(ROBOT.keep_fitting(types.SimpleNamespace(markers=[marker(version, "odom")])))
            deletes = types.SimpleNamespace(markers=[marker(version, "", action=3)])
            self.assertTrue(ROBOT.keep_fitting(deletes))
            self.assertEqual(ROBOT.markers(deletes)[1]["markers"][0]["action"], 3)

    def test_a_stamp_and_a_report(self):
        for version in (ros_1, ros_2):
            self.assertEqual(ROBOT.state(odometry(version))[1]["header"], {"stamp": SECONDS + 0.5, "frame_id": "darpa"})
            self.assertEqual(ROBOT.report(marker(version)), (1.5, -2.0, 0.0, "Backpack"))


class Queues(unittest.TestCase):
    """Messages that come faster than they are sent."""

    def outbox(self, robot_check, most):
        self.free, self.sent = threading.Semaphore(0), []

        def send(_, content):
            self.free.acquire()
            self.sent.append(content["msg"]["header"]["stamp"])

        return Outbox(robot_check, ROBOT.map, send, most)

    def of_turn(self, made, turn):
        made.header.stamp.secs = turn
        return made

    def has_sent(self, turns):
        for _ in turns:
            self.free.release()
        wait_until(lambda: len(self.sent) == len(turns), lambda: f"{self.sent}")
        self.assertEqual([int(stamp) for stamp in self.sent], list(turns))

    def test_each_cloud_is_sent_in_order(self):
        box = self.outbox(ROBOT.fits, MOST)
        for turn in range(1, 101):
            box.put(self.of_turn(cloud(ros_1), turn))
        self.has_sent(range(1, 101))

    def test_a_dropped_message_is_an_error_in_the_log(self):
        box = self.outbox(ROBOT.fits, 10)
        box.put(self.of_turn(cloud(ros_1), 1))
        wait_until(lambda: not box.waiting, "the first one to be sent")
        with self.assertLogs("rosout.adit", "ERROR") as said:
            for turn in range(2, 15):
                box.put(self.of_turn(cloud(ros_1), turn))
        self.assertEqual((len(said.output), box.dropped), (3, 3))
        self.assertIn("dropped the oldest of 10 queued messages (3 in all)", said.output[-1])
        self.has_sent([1, *range(5, 15)])

    def test_a_grid_of_another_frame_replaces_none(self):
        box = self.outbox(ROBOT.fits, 1)
        box.put(self.of_turn(grid(ros_1), 1))
        wait_until(lambda: not box.waiting, "the first one to be sent")
        for turn in (2, 3):
            box.put(self.of_turn(grid(ros_1), turn))
        with self.assertLogs("rosout.adit"):
            box.put(self.of_turn(grid(ros_1, "odom"), 4))
        self.has_sent([1, 3])


PUBLISHER = """
import rospy, std_msgs.msg
from geometry_msgs.msg import Point, Pose, PoseWithCovariance, Quaternion, Vector3
from nav_msgs.msg import MapMetaData, OccupancyGrid, Odometry
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray

rospy.init_node("robot")
head = Header(stamp=rospy.Time(1700000000, 500000000), frame_id="map")
pose = Pose(Point(1.5, -2, 0), Quaternion(0, 0, 0.6, 0.8))
find = Marker(header=head, ns="finds", id=3, type=2, pose=pose, scale=Vector3(0.5, 0.5, 0.5), color=ColorRGBA(1, 0.5, 0.25, 1),
              lifetime=rospy.Duration(3000), text="Backpack")
fields = [PointField(name, 4 * at, 7, 1) for at, name in enumerate("xyz")]
said = {"map": OccupancyGrid(head, MapMetaData(resolution=0.25, width=3, height=2, origin=pose), CELLS),
        "points": PointCloud2(head, 1, 2, fields, False, 16, 32, POINTS, True),
        "odometry": Odometry(header=head, pose=PoseWithCovariance(pose=pose)),
        "markers": MarkerArray([find]), "report": find}
kept = [rospy.Publisher(topic, type(message), latch=True, queue_size=1) for topic, message in said.items()]
for publisher, message in zip(kept, said.values()):
    publisher.publish(message)
rospy.spin()
"""


@unittest.skipUnless(importlib.util.find_spec("rospy"), "Debian's ROS 1 (ros-core, python3-rospy, its messages) is not here")
class Node(unittest.TestCase):
    """The node, a publisher and Debian's ROS master on the team's host."""

    # A node that sets parameters ends if there is no master yet.
    MASTER_FIRST = ("bash", "-c", 'until (: < /dev/tcp/127.0.0.1/11311) 2> /dev/null; do sleep 0.05; done; exec "$@"', "node")

    def start(self, stage, name, *command):
        ros = ["env", "ROS_MASTER_URI=http://127.0.0.1:11311", "ROS_IP=127.0.0.1", f"ROS_HOME={stage.folder}",
               f"ADIT_TOKEN={programs.TEAM_TOKEN}"]
        made = programs.Program(stage.network, stage.network.team, stage.folder / f"{name}.log", [*ros, *command])
        self.addCleanup(made.stop, signal.SIGKILL)
        return made

    def test_each_topic_arrives_once(self):
        with Stage() as stage:
            python = [*self.MASTER_FIRST, "/usr/bin/python3", "-B"]
            self.start(stage, "rosmaster", "rosmaster", "--core")
            node = self.start(stage, "node", *python, SHOWN / "ros_node.py", f"_url:={stage.box.url}", "_robot:=husky",
                              "_frame:=map")
            made = PUBLISHER.replace("CELLS", repr(CELLS)).replace("POINTS", repr(POINTS))
            self.start(stage, "publisher", *python, "-c", made)
            post = stage.post
            for uri, count in (("/map/update", 2), ("/state/update", 1), ("/markers/update", 1)):
                wait_until(lambda uri=uri, count=count: len(post.requests(uri)) >= count, lambda uri=uri: f"{uri}: {node.output()}", 60)
            wait_until(post.recorded, lambda: f"the report: {node.output()}", 60)
            self.assertEqual(post.violations(), [])
            self.assertEqual([(made["x"], made["y"], made["z"], made["type"]) for made in post.recorded()],
                             [(1.5, -2.0, 0.0, "Backpack")])
            kinds = {request["message"]["type"]: request["message"]["msg"] for request in post.requests("/map/update")}
            self.assertEqual(sorted(kinds), ["OccupancyGrid", "PointCloud2"])
            self.assertEqual(kinds["OccupancyGrid"]["info"]["width"], 3)
            self.assertEqual(kinds["OccupancyGrid"]["info"]["origin"], POSE)
            self.assertEqual(post.requests("/state/update")[0]["message"]["poses"], [{"name": "husky", **POSE}])
            (found,) = post.requests("/markers/update")[0]["message"]["markers"]
            self.assertEqual((found["ns"], found["id"]), ("finds", 3))
            self.assertTrue(LIFETIME - 100 < found["lifetime"] <= LIFETIME)
