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
    """The messages of one robot, in `frame`, the Command Post's "darpa"."""

    def __init__(self, name, frame):
        self.name, self.frame = name, frame

    def fits(self, message):
        """Whether a message is of the frame. Otherwise logs it."""
        given = message.header.frame_id.lstrip("/")
        deletes = getattr(message, "action", 0) != 0 and not given  # RViz needs no frame to delete
        if given == self.frame or deletes:
            return True
        log.error("not sent: expected frame %s, got %s", self.frame, given)
        return False

    def keep_fitting(self, message):
        """Removes other markers from a MarkerArray. Whether one is left."""
        message.markers = [marker for marker in message.markers if self.fits(marker)]
        return bool(message.markers)

    @staticmethod
    def in_darpa(message):
        return {**plain(message), "header": {"stamp": plain(message.header.stamp), "frame_id": "darpa"}}

    def map(self, message):
        made, is_grid = self.in_darpa(message), hasattr(message, "info")
        if is_grid:
            cells = array.array("b", message.data).tobytes()  # a tuple in ROS 1, an array in ROS 2
            made.update(data=base64.b64encode(gzip.compress(cells, 1)).decode(), compression="gzip")
        return ("map", {"type": "OccupancyGrid" if is_grid else "PointCloud2", "name": self.name, "msg": made})

    def state(self, odometry):
        made = self.in_darpa(odometry)
        return ("state", {"header": made["header"], "poses": [{"name": self.name, **made["pose"]["pose"]}]})

    def markers(self, message):
        return ("markers", {"markers": [self.in_darpa(marker) for marker in message.markers]})

    def report(self, marker):
        made = self.in_darpa(marker)
        return (*made["pose"]["position"].values(), marker.text)
