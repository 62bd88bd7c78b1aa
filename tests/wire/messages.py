"""Messages as known team software writes them (every client style from the field), and their meaning."""

import base64
import dataclasses
import gzip
import json
import zlib

import cbor2

import programs


@dataclasses.dataclass(frozen=True)
class Style:
    """A client's style of writing requests."""

    format: str = "json"  # or cbor
    data: str = "plain"  # base64 or byte string; "gzip": the same, compressed; "integers": an array, -1 for unknown
    body: str = ""  # Content-Encoding of the whole body
    ros: bool = False  # whole ROS dictionaries: seq, {secs, nsecs}, row_step, zero quaternions ...
    browser: bool = False  # charset parameter, trailing slash, bearer in lower case
    chunked: bool = False  # Transfer-Encoding: chunked
    expect: bool = False  # Expect: 100-continue

    def __str__(self):
        words = [self.format, self.data, self.body]
        words += [name for name in ("ros", "browser", "chunked", "expect") if getattr(self, name)]
        return "+".join(word for word in words if word)


def stamp(seconds, style):
    if not style.ros:
        return seconds
    return {"secs": int(seconds), "nsecs": round((seconds - int(seconds)) * 1e9)}


def header(seconds, style):
    made = {"stamp": stamp(seconds, style), "frame_id": "darpa"}
    if style.ros:
        made["seq"] = 7
    return made


def map_update(source, name, seconds, style):
    """The body's dictionary for a Grid or Cloud of maps.py. If `name` is None, the name is omitted."""
    message = {"header": header(seconds, style), **source.head(), "data": bulk(source, style)}
    if style.data == "gzip":
        message["compression"] = "gzip"
    if style.ros and source.type == "OccupancyGrid":
        message["info"] = {**message["info"], "map_load_time": {"secs": 0, "nsecs": 0}}
        message["info"]["origin"] = {**message["info"]["origin"], "orientation": dict.fromkeys("xyzw", 0)}
    if style.ros and source.type == "PointCloud2":
        points = len(source.data) // source.point_step
        message |= {"height": 1, "width": points, "row_step": len(source.data), "is_dense": True}
    update = {"type": source.type, "msg": message}
    if name is not None:
        update["name"] = name
    return update


def bulk(source, style):
    data = source.data
    if style.data == "integers":
        signed = source.type == "OccupancyGrid"
        return [-1 if signed and value == 255 else value for value in data]
    if style.data == "gzip":
        data = gzip.compress(data, 6)
    return base64.b64encode(data).decode() if style.format == "json" else data


def headers(style, token=programs.TEAM_TOKEN):
    scheme = "bearer" if style.browser else "Bearer"
    parameters = "; charset=utf-8" if style.browser else ""
    made = {"Authorization": f"{scheme} {token}", "Content-Type": f"application/{style.format}{parameters}"}
    if style.body:
        made["Content-Encoding"] = style.body
    if style.expect:
        made["Expect"] = "100-continue"
    return made


def body(message, style):
    content = json.dumps(message).encode() if style.format == "json" else cbor2.dumps(message)
    if style.body == "gzip":
        content = gzip.compress(content, 3)
    if style.body == "deflate":
        content = zlib.compress(content, 3)
    return content


def pieces(content):
    """A generator, so that `requests` sends the body chunked."""
    for at in range(0, len(content), 30000):
        yield content[at:at + 30000]


def post(session, url, uri, message, style, token=programs.TEAM_TOKEN, timeout=60, content=None):
    """`content`: the bytes to send instead of body()'s."""
    content = body(message, style) if content is None else content
    if style.chunked:
        content = pieces(content)
    return session.post(url + uri + ("/" if style.browser else ""), data=content, headers=headers(style, token),
                        timeout=timeout)
