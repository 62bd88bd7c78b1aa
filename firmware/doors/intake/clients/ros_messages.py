"""Converts messages of ROS 1 and ROS 2 to the arguments of a Client's update() and report()."""
import array
import base64
import gzip
import logging

log = logging.getLogger("rosout.adit")  # rospy shows it


def plain(value):
    """A ROS message, or a part of it, in the ICD's form: times in seconds, bytes in base64."""
    if isinstance(value, (bytes, array.array)):
        return base64.b64encode(bytes(value)).decode() if isinstance(value, bytes) or value.itemsize == 1 else list(value)
    if isinstance(value, (list, tuple)):
        return [plain(each) for each in value]
    for seconds, nanoseconds in (("secs", "nsecs"), ("sec", "nanosec")):
        if hasattr(value, seconds):
            return getattr(value, seconds) + getattr(value, nanoseconds) / 1e9
    if hasattr(value, "get_fields_and_field_types"):  # ROS 2: its __slots__ have other names
        return {name: plain(getattr(value, name)) for name in value.get_fields_and_field_types()}
    return {name: plain(getattr(value, name)) for name in value.__slots__} if hasattr(value, "__slots__") else value


class Robot:
    """The messages of one robot. None if the frame is not `frame`, the Command Post's "darpa"."""

    def __init__(self, name, frame):
        self.name, self.frame = name, frame

    def of_frame(self, message):
        given = message.header.frame_id.lstrip("/")
        deletes = getattr(message, "action", 0) != 0 and not given  # RViz needs no frame to delete
        if given != self.frame and not deletes:
            log.error("not sent: expected frame %s, got %s", self.frame, given)
            return None
        return {**plain(message), "header": {"stamp": plain(message.header.stamp), "frame_id": "darpa"}}

    def map(self, message):
        made, is_grid = self.of_frame(message), hasattr(message, "info")
        if made and is_grid:
            cells = array.array("b", message.data).tobytes()  # a tuple in ROS 1, an array in ROS 2
            made.update(data=base64.b64encode(gzip.compress(cells, 1)).decode(), compression="gzip")
        return made and ("map", {"type": "OccupancyGrid" if is_grid else "PointCloud2", "name": self.name, "msg": made})

    def state(self, odometry):
        made = self.of_frame(odometry)
        return made and ("state", {"header": made["header"], "poses": [{"name": self.name, **made["pose"]["pose"]}]})

    def markers(self, message):
        made = [marker for marker in map(self.of_frame, message.markers) if marker]
        return ("markers", {"markers": made}) if made else None

    def report(self, marker):
        made = self.of_frame(marker)
        return made and (*made["pose"]["position"].values(), marker.text)
