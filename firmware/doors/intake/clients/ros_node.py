#!/usr/bin/python3
"""A node for ROS 1 and ROS 2: sends one robot's topics to Adit, with the token in ADIT_TOKEN.

Parameters: ~url (http://10.0.0.1:8000), ~robot (its name at the Command Post), ~frame (the team's frame that is the Command
Post's "darpa"; messages of other frames are not sent). Topics: map (OccupancyGrid), points (PointCloud2), odometry (Odometry), markers
(MarkerArray), report (Marker: the artifact's type in its text, the position in its pose)."""
import collections
import importlib.util
import logging
import os
import sys
import threading

from client import Client
from ros_messages import Robot, log


MOST = 500  # queued messages of a topic


class Outbox(threading.Thread):
    """Sends queued messages in order, as fast as Adit accepts them. `most` 1: only the newest, because it contains the older ones.
    Otherwise it drops the oldest of more than `most`, with an error in the log."""

    def __init__(self, check, make, send, most):
        super().__init__(daemon=True)
        self.check, self.make, self.send, self.dropped = check, make, send, 0
        self.waiting, self.given = collections.deque(maxlen=most), threading.Semaphore(0)
        self.start()

    def put(self, message):
        if not self.check(message):  # now, so that it does not replace a message that can be sent
            return
        if self.waiting.maxlen > 1 and len(self.waiting) == self.waiting.maxlen:
            self.dropped += 1
            log.error("%s: dropped the oldest of %d queued messages (%d in all)", self.make.__name__, self.waiting.maxlen, self.dropped)
        self.waiting.append(message)
        self.given.release()

    def run(self):
        while self.given.acquire():
            if not self.waiting:  # a newer message replaced it and was sent
                continue
            try:
                log.info("answered: %s", self.send(*self.make(self.waiting.popleft())))
            except Exception as why:  # the next message may be valid
                log.error("%s: %s", type(why).__name__, why)


def outboxes(parameter):
    """For each topic: the package and type of its message, and its outbox."""
    url, name, frame = (parameter(name) or sys.exit(f"adit: the parameter {name} is missing") for name in ("url", "robot", "frame"))
    client, robot = Client(url, os.environ["ADIT_TOKEN"]), Robot(name, frame)
    fits = robot.fits
    return {"map": ("nav_msgs", "OccupancyGrid", Outbox(fits, robot.map, client.update, 1)),
            "points": ("sensor_msgs", "PointCloud2", Outbox(fits, robot.map, client.update, MOST)),  # each may have other points
            "odometry": ("nav_msgs", "Odometry", Outbox(fits, robot.state, client.update, 1)),
            "markers": ("visualization_msgs", "MarkerArray", Outbox(robot.keep_fitting, robot.markers, client.update, MOST)),
            "report": ("visualization_msgs", "Marker", Outbox(fits, robot.report, client.report, MOST))}


def subscribe(parameter, subscriber):
    for topic, (package, name, outbox) in outboxes(parameter).items():
        subscriber(getattr(importlib.import_module(package + ".msg"), name), topic, outbox)


def ros_1(rospy):
    rospy.init_node("adit")
    subscribe(lambda name: rospy.get_param("~" + name, ""), lambda kind, topic, box: rospy.Subscriber(topic, kind, box.put))
    rospy.spin()


def ros_2(rclpy):
    logging.basicConfig(level=logging.INFO)
    rclpy.init()
    node = rclpy.create_node("adit")
    from_any = rclpy.qos.QoSProfile(depth=100, reliability=rclpy.qos.ReliabilityPolicy.BEST_EFFORT)  # from publishers of either
    subscribe(lambda name: node.declare_parameter(name, "").value,
              lambda kind, topic, box: node.create_subscription(kind, topic, box.put, 100 if topic in ("markers", "report") else from_any))
    rclpy.spin(node)


if __name__ == "__main__":
    if importlib.util.find_spec("rospy"):
        ros_1(importlib.import_module("rospy"))
    else:
        importlib.import_module("rclpy.qos")
        ros_2(importlib.import_module("rclpy"))
