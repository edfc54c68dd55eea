"""Bags of ROS 1 and 2, written here with the library and read back."""

from pathlib import Path

import numpy as np
import pytest

import pfkit as pf
from pfkit import worlds

pytest.importorskip("rosbags")
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_typestore

T0 = 1_700_000_000
KINDS = ("bag", "sqlite3", "mcap")


@pytest.fixture(scope="module")
def drive():
    angles = np.linspace(-np.pi / 2, np.pi / 2, 31)
    laser = pf.BeamModel(worlds.office(), angles, 8.0, 0.03, 1.0, 0.9, 0.03, 0.03, 0.04)
    driver = pf.PurePursuit(worlds.OFFICE_ROUTE, v=0.5, dt=0.2)
    motion = pf.VelocityMotion((0.005, 0.001, 0.001, 0.005))
    return pf.simulate_log(
        worlds.OFFICE_START, driver, motion, laser, np.random.default_rng(6), steps=30
    )


class Scribe:
    """Writes messages of one of the three kinds of bag."""

    def __init__(self, path: Path, kind: str):
        self.first = kind == "bag"
        self.store = get_typestore(Stores.ROS1_NOETIC if self.first else Stores.ROS2_HUMBLE)
        if self.first:
            self.writer = Writer1(path / "drive.bag")
        else:
            plugin = StoragePlugin.MCAP if kind == "mcap" else StoragePlugin.SQLITE3
            self.writer = Writer2(path / "drive", version=9, storage_plugin=plugin)
        self.topics = {}

    def make(self, name, *fields):
        return self.store.types[name](*fields)

    def header(self, t, frame):
        ns = round((T0 + t) * 1e9)
        stamp = self.make("builtin_interfaces/msg/Time", ns // 10**9, ns % 10**9)
        return self.make("std_msgs/msg/Header", *([0] if self.first else []), stamp, frame)

    def pose(self, x, y, yaw):
        q = self.turned(0.0, yaw)
        return self.make(
            "geometry_msgs/msg/Pose", self.make("geometry_msgs/msg/Point", x, y, 0.0), q
        )

    def turned(self, roll, yaw):
        a, b, c, d = np.cos(roll / 2), np.sin(roll / 2), np.cos(yaw / 2), np.sin(yaw / 2)
        q = (b * c, b * d, a * d, a * c)
        return self.make("geometry_msgs/msg/Quaternion", *(float(v) for v in q))

    def odometry(self, t, pose):
        zero = self.make("geometry_msgs/msg/Vector3", 0.0, 0.0, 0.0)
        twist = self.make("geometry_msgs/msg/Twist", zero, zero)
        none = np.zeros(36)
        return self.make(
            "nav_msgs/msg/Odometry",
            self.header(t, "odom"),
            "base_link",
            self.make("geometry_msgs/msg/PoseWithCovariance", self.pose(*pose), none),
            self.make("geometry_msgs/msg/TwistWithCovariance", twist, none),
        )

    def scan(self, t, z, r_max):
        start, step = z[1, 0], z[1, 1] - z[1, 0]
        ranges = np.where(z[0] >= r_max, np.inf, z[0]).astype(np.float32)
        return self.make(
            "sensor_msgs/msg/LaserScan",
            self.header(t, "laser"),
            *(float(v) for v in (start, -start, step, 0.0, 0.0, 0.2, r_max)),
            ranges,
            np.empty(0, np.float32),
        )

    def seat(self, parent, child, x, roll, yaw):
        move = self.make("geometry_msgs/msg/Vector3", x, 0.0, 0.3)
        transform = self.make("geometry_msgs/msg/Transform", move, self.turned(roll, yaw))
        return self.make(
            "geometry_msgs/msg/TransformStamped", self.header(0, parent), child, transform
        )

    def write(self, topic, name, t, message):
        if topic not in self.topics:
            self.topics[topic] = self.writer.add_connection(topic, name, typestore=self.store)
        turn = self.store.serialize_ros1 if self.first else self.store.serialize_cdr
        self.writer.write(self.topics[topic], round((T0 + t) * 1e9), turn(message, name))


def write(folder, log, kind="bag", seats=(), second=False):
    scribe = Scribe(folder, kind)
    odometer = pf.dead_reckoning(log, start=np.zeros(3))
    with scribe.writer:
        if seats:
            tf = scribe.make("tf2_msgs/msg/TFMessage", [scribe.seat(*seat) for seat in seats])
            scribe.write("/tf_static", "tf2_msgs/msg/TFMessage", 0, tf)
        for k, (t, _, z, x) in enumerate(log):
            for topic, pose in (("/odom", odometer[:, k]), ("/truth", x)):
                message = scribe.odometry(t, [float(v) for v in pose])
                scribe.write(topic, "nav_msgs/msg/Odometry", t, message)
            for topic in ("/scan", "/back") if second else ("/scan",):
                scribe.write(topic, "sensor_msgs/msg/LaserScan", t, scribe.scan(t, z, 8.0))
    log.world.save(folder / "map.yaml")


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_written_is_read(tmp_path, drive, kind):
    write(tmp_path, drive, kind)
    log = pf.load_log(tmp_path, truth="/truth")
    assert log.rig == pf.Rig("laser", "increments", r_max=8.0)
    np.testing.assert_allclose(log.t, drive.t - drive.t[0], atol=1e-6)
    np.testing.assert_allclose(log.truth[:2], drive.truth[:2], atol=1e-6)
    for got, sent in zip(log.z, drive.z, strict=True):
        heard = sent[:, sent[0] >= 0.2]  # the scanner's least range
        np.testing.assert_allclose(got, heard, atol=1e-6)
    path = pf.dead_reckoning(log, start=np.zeros(3))[:2]
    own = pf.dead_reckoning(drive, start=np.zeros(3))
    np.testing.assert_allclose(path, pf.between(own[:, :1], own)[:2], atol=1e-6)
    assert "no static transform leads from base_link to laser" in log.notes[0]


def test_a_storage_file_alone_is_a_bag(tmp_path, drive):
    write(tmp_path, drive, "mcap")
    (tmp_path / "drive" / "metadata.yaml").unlink()
    next((tmp_path / "drive").glob("*.mcap")).rename(tmp_path / "alone.mcap")
    assert len(pf.load_log(tmp_path, truth="/truth")) == len(drive)


def test_the_mounting_is_found_through_a_chain_also_upside_down(tmp_path, drive):
    seats = [("base_link", "mast", 0.2, 0.0, np.pi / 2), ("mast", "laser", 0.1, np.pi, 0.3)]
    write(tmp_path, drive, "sqlite3", seats=seats)
    rig = pf.load_log(tmp_path, truth="/truth").rig
    np.testing.assert_allclose(rig.mount, (0.2, 0.1, np.pi / 2 + 0.3), atol=1e-9)
    assert rig.flipped


def test_topics_are_chosen_and_named(tmp_path, drive):
    write(tmp_path, drive, second=True)
    with pytest.raises(pf.DataError, match=r"2 topics of sensor_msgs/msg/LaserScan: /back, /scan"):
        pf.load_log(tmp_path, truth="/truth")
    assert len(pf.load_log(tmp_path, truth="/truth", scan="/scan")) == len(drive)
    with pytest.raises(pf.DataError, match=r"topic /nose is not in the bag; for --scan there is"):
        pf.load_log(tmp_path, truth="/truth", scan="/nose")
    with pytest.raises(pf.DataError, match=r"topic /odom is a nav_msgs/msg/Odometry; for --scan"):
        pf.load_log(tmp_path, truth="/truth", scan="/odom")
    with pytest.raises(pf.DataError, match=r"which topic holds the truth\? --truth TOPIC"):
        pf.load_log(tmp_path)
    with pytest.raises(pf.DataError, match=r"2 topics of nav_msgs/msg/Odometry: /odom, /truth"):
        pf.load_log(tmp_path, need_truth=False, scan="/scan")
    log = pf.load_log(tmp_path, need_truth=False, scan="/scan", odometry="/odom")
    assert log.truth is None


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("share", [0.0, 0.4, 0.97])
def test_a_bag_that_is_cut_off_is_named(tmp_path, drive, kind, share):
    write(tmp_path, drive, kind)
    endings = {"bag": "*.bag", "mcap": "drive/*.mcap", "sqlite3": "drive/*.db3"}
    path = next(tmp_path.glob(endings[kind]))
    raw = path.read_bytes()
    path.write_bytes(raw[: int(share * len(raw))])
    with pytest.raises(pf.DataError, match=r"is it cut off\?"):
        pf.load_log(tmp_path, truth="/truth")
