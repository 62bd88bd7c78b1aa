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
import time

from client import Client
from ros_messages import Robot, log


class Outbox(threading.Thread):
    """Sends queued messages in order: only the newest of a robot's maps and states (`most` 1), and all others."""

    def __init__(self, make, send, most=None):
        super().__init__(daemon=True)
        self.make, self.send, self.waiting, self.given = make, send, collections.deque(maxlen=most), threading.Semaphore(0)
        self.start()

    def put(self, message):
        self.waiting.append(message)
        self.given.release()

    def run(self):
        while self.given.acquire():
            if not self.waiting:  # a newer message replaced it and was sent
                continue
            try:
                made = self.make(self.waiting.popleft())
                if made is not None:
                    log.info("answered: %s", self.send(*made))
            except Exception as why:  # the next message may be valid
                log.error("%s: %s", type(why).__name__, why)
            if self.waiting.maxlen:
                time.sleep(1)  # the Command Post accepts one a second


def outboxes(parameter):
    """For each topic: the package and type of its message, and its outbox."""
    url, name, frame = (parameter(name) or sys.exit(f"adit: the parameter {name} is missing") for name in ("url", "robot", "frame"))
    client, robot = Client(url, os.environ["ADIT_TOKEN"]), Robot(name, frame)
    return {"map": ("nav_msgs", "OccupancyGrid", Outbox(robot.map, client.update, 1)),
            "points": ("sensor_msgs", "PointCloud2", Outbox(robot.map, client.update, 1)),
            "odometry": ("nav_msgs", "Odometry", Outbox(robot.state, client.update, 1)),
            "markers": ("visualization_msgs", "MarkerArray", Outbox(robot.markers, client.update)),
            "report": ("visualization_msgs", "Marker", Outbox(robot.report, client.report))}


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
    newest = rclpy.qos.qos_profile_sensor_data  # receives from publishers of either reliability
    subscribe(lambda name: node.declare_parameter(name, "").value,
              lambda kind, topic, box: node.create_subscription(kind, topic, box.put, newest if box.waiting.maxlen else 100))
    rclpy.spin(node)


if __name__ == "__main__":
    if importlib.util.find_spec("rospy"):
        ros_1(importlib.import_module("rospy"))
    else:
        importlib.import_module("rclpy.qos")
        ros_2(importlib.import_module("rclpy"))
