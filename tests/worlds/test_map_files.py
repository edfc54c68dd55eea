"""ROS maps on disk: round trips, and every way a file can be wrong."""

import sys

import numpy as np
import pytest

import pfkit as pf
from pfkit.worlds.map_files import read_pgm, read_settings, write_pgm

GOOD = """image: room.pgm
resolution: 0.050000
origin: [-1.5, 2.0, 0.25]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""
PICTURE = b"P5\n# a comment, as gimp writes it\n3 2\n255\n" + bytes([0, 254, 205, 255, 100, 1])


@pytest.fixture
def room(tmp_path):
    (tmp_path / "room.yaml").write_text(GOOD)
    (tmp_path / "room.pgm").write_bytes(PICTURE)
    return tmp_path / "room.yaml"


def test_a_map_of_map_server_is_read_as_ros_reads_it(room):
    world = pf.OccupancyGrid.load(room)
    assert world.resolution == 0.05 and world.origin == (-1.5, 2.0, 0.25)
    # the picture's first row is the top of the map; (255 - grey) / 255 is the occupancy
    np.testing.assert_array_equal(world.occupied, [[False, False, True], [True, False, False]])
    np.testing.assert_array_equal(world.free, [[True, False, False], [False, True, False]])
    np.testing.assert_allclose(world.p[1], np.array([255, 1, 50]) / 255)


def test_negate_turns_the_greys_round(room):
    plain = pf.OccupancyGrid.load(room)
    room.write_text(GOOD.replace("negate: 0", "negate: 1"))
    np.testing.assert_allclose(pf.OccupancyGrid.load(room).p, 1 - plain.p)


@pytest.mark.parametrize("text", [False, True])
def test_a_map_survives_saving_and_loading(tmp_path, text):
    rng = np.random.default_rng(0)
    p = rng.integers(0, 256, (7, 40)) / 255
    world = pf.OccupancyGrid(p, 0.1, (0.1, -2.0 / 3.0, 1.25), 0.7, 0.3)
    world.save(tmp_path / "map.yaml", text=text)
    back = pf.OccupancyGrid.load(tmp_path / "map.yaml")
    np.testing.assert_allclose(back.p, p, atol=1e-15)
    for name in ("resolution", "origin", "occupied_thresh", "free_thresh"):
        assert getattr(back, name) == getattr(world, name)
    assert (tmp_path / "map.pgm").read_bytes()[:2] == (b"P2" if text else b"P5")
    assert not text or max(map(len, (tmp_path / "map.pgm").read_text().split("\n"))) <= 70


def test_yaml_as_other_programs_write_it(room):
    room.write_text(
        "---\n# saved by hand\nimage: 'room.pgm'  # beside it\nresolution: 5e-2\n"
        "origin:\n  - -1.5\n  - 2.0\n  - 0.25\nnegate: 0\noccupied_thresh: 0.65\n"
        "free_thresh: 0.196\nmode: trinary\n"
    )
    world = pf.OccupancyGrid.load(str(room))
    assert world.origin == (-1.5, 2.0, 0.25) and world.resolution == 0.05


def test_text_pictures_may_hold_comments_and_any_line_breaks(tmp_path):
    (tmp_path / "a.pgm").write_bytes(b"P2 3 # wide\r\n2\n15\n0 1 2\n3 4 # nearly\n15\n")
    grey, white = read_pgm(tmp_path / "a.pgm")
    np.testing.assert_array_equal(grey, [[0, 1, 2], [3, 4, 15]])
    assert white == 15


def test_windows_line_ends_and_byte_order_marks(room):
    room.write_bytes(b"\xef\xbb\xbf" + GOOD.replace("\n", "\r\n").encode())
    assert read_settings(room).image == "room.pgm"


@pytest.mark.parametrize(
    "old, new, reason",
    [
        ("image: room.pgm\n", "", "image missing"),
        ("negate: 0", "negate: 2", "0 or 1"),
        ("negate: 0", "negate: 0\nnegate: 1", "twice"),
        ("negate: 0", "inverse: 0", "line 4: inverse.*negate is missing"),
        ("negate: 0", "negate", "line 4: expected key: value"),
        ("0.050000", "five", "resolution must be a number"),
        ("0.050000", "", "resolution"),
        ("0.050000", ".nan", "resolution"),
        ("0.050000", "nan", "finite"),
        ("0.050000", "0", "resolution must be finite and > 0"),
        ("[-1.5, 2.0, 0.25]", "[-1.5, 2.0]", r"\[x, y, yaw\]"),
        ("0.65", "0.1", "thresholds"),
        ("0.65", "1.1", "occupied_thresh"),
        (
            "free_thresh: 0.196",
            "free_thresh: 0.196\nmode: grey",
            "mode must be one of trinary, scale, raw, got 'grey'",
        ),
        ("room.pgm", "hall.pgm", "hall.pgm: cannot be read"),
    ],
)
def test_bad_settings_name_the_file_and_the_reason(room, old, new, reason):
    room.write_text(GOOD.replace(old, new))
    with pytest.raises(pf.DataError, match=reason) as caught:
        pf.OccupancyGrid.load(room)
    assert str(room.parent) in str(caught.value)


@pytest.mark.parametrize(
    "picture, reason",
    [
        (b"", "not a picture that is known"),
        (b"a plan of the house", "not a picture that is known"),
        (b"\x89PNG\r\n", "not a picture that is known"),
        (b"P5\n3\n", "bad header"),
        (b"P5\n3 two\n255\nabcdef", "bad header"),
        (b"P5\n-3 2\n255\nabcdef", "bad header"),
        (b"P5\n3 2 # and then nothing", "bad header"),
        (b"P5\n0 2\n255\n", "sizes must be"),
        (b"P5\n3 2\n65536\nabcdefabcdef", "white 65536"),
        (b"P5\n3 2\n65535\nabcdefabcde", "6 pixels, the file has 5"),
        (PICTURE[:-1], "cut off"),
        (PICTURE + b"more", "cut off"),
        (b"P2\n3 2\n255\n1 2 3 4 5", "6 pixels, the file has 5"),
        (b"P2\n3 2\n255\n1 2 3 4 5 6 7", "6 pixels, the file has 7"),
        (b"P2\n3 2\n255\n1 2 3 4 5 x", "not a whole number"),
        (b"P2\n3 2\n255\n1 2 3 4 5 -6", "outside"),
        (b"P2\n3 2\n100\n1 2 3 4 5 101", "outside"),
        (b"P5\n3 2\n100\nabcdef", "outside"),
    ],
)
def test_bad_pictures_name_the_file_and_the_reason(room, picture, reason):
    (room.parent / "room.pgm").write_bytes(picture)
    with pytest.raises(pf.DataError, match=reason) as caught:
        pf.OccupancyGrid.load(room)
    assert "room.pgm" in str(caught.value)


def test_a_picture_given_for_the_yaml_and_a_missing_file(room):
    with pytest.raises(pf.DataError, match="not its picture"):
        pf.OccupancyGrid.load(room.with_suffix(".pgm"))
    with pytest.raises(pf.DataError, match="check the path"):
        pf.OccupancyGrid.load(room.with_name("none.yaml"))


def test_the_bytes_written_are_the_bytes_read(tmp_path):
    grey = np.random.default_rng(1).integers(0, 256, (5, 4)).astype(np.uint8)
    for text in (False, True):
        write_pgm(tmp_path / "b.pgm", grey, text)
        np.testing.assert_array_equal(read_pgm(tmp_path / "b.pgm")[0], grey)


def test_what_is_no_path_is_named():
    with pytest.raises(TypeError, match="PathLike object, not"):
        pf.OccupancyGrid.load(3)


def occupancy_of(room, mode="trinary", negate="0"):
    text = GOOD.replace("room.pgm", "room.png").replace("negate: 0", f"negate: {negate}")
    room.write_text(f"{text}mode: {mode}\n")
    world = pf.OccupancyGrid.load(room)
    return np.where(world.occupied, 100, np.where(world.free, 0, -1))[::-1]


def draw(room, pixels, mode):
    Image = pytest.importorskip("PIL.Image")
    image = Image.fromarray(np.asarray(pixels, dtype=np.uint8), mode=None)
    image.convert(mode).save(room.with_name("room.png"))


GREYS = np.array([[0, 254, 205], [255, 100, 1]], dtype=np.uint8)


@pytest.mark.parametrize("mode", ["L", "RGB", "P"])
def test_a_png_is_the_pgm_of_the_same_greys(room, mode):
    draw(room, GREYS, mode)
    plain = pf.OccupancyGrid.load(room)
    np.testing.assert_array_equal(
        occupancy_of(room), np.where(plain.occupied, 100, np.where(plain.free, 0, -1))[::-1]
    )


@pytest.mark.parametrize("word, turned", [("false", False), ("True", True), ("1", True)])
def test_negate_in_words(room, word, turned):
    p = pf.OccupancyGrid.load(room).p
    room.write_text(GOOD.replace("negate: 0", f"negate: {word}"))
    np.testing.assert_allclose(pf.OccupancyGrid.load(room).p, 1 - p if turned else p)


def test_without_negate_white_is_free_and_foreign_keys_are_passed_over(room):
    p = pf.OccupancyGrid.load(room).p
    room.write_text(GOOD.replace("negate: 0\n", ""))
    np.testing.assert_array_equal(pf.OccupancyGrid.load(room).p, p)
    room.write_text(GOOD.replace("[-1.5, 2.0, 0.25]", "[-1.5, 2.0,\n  0.25]") + "zones:\n  a: 3\n")
    assert pf.OccupancyGrid.load(room).origin == (-1.5, 2.0, 0.25)


def test_transparency_is_unknown_in_scale_and_a_colour_in_trinary(room):
    see_through = np.stack([GREYS] * 3 + [np.full_like(GREYS, 255)], axis=-1)
    see_through[0, 0, 3] = see_through[1, 0, 3] = 0
    draw(room, see_through, "RGBA")
    assert occupancy_of(room, "scale")[:, 0].tolist() == [-1, -1]
    # (0 + 0 + 0 + 0) / 4 is a wall; (255 * 3 + 0) / 4 = 191 is .25 occupied: between the two
    assert occupancy_of(room)[:, 0].tolist() == [100, -1]


def test_raw_greys_are_per_cent(room):
    draw(room, [[0, 100, 50], [255, 10, 101]], "L")
    assert occupancy_of(room, "raw").tolist() == [[0, 100, -1], [-1, 0, -1]]


def test_sixteen_bits_a_pixel(room):
    deep = (GREYS.astype(">u2") * 257).tobytes()
    p = pf.OccupancyGrid.load(room).p
    (room.parent / "room.pgm").write_bytes(b"P5\n3 2\n65535\n" + deep)
    np.testing.assert_allclose(pf.OccupancyGrid.load(room).p, p, atol=1e-12)


def test_a_cut_png_and_pillow_left_out(room, monkeypatch):
    draw(room, np.tile(GREYS, (40, 40)), "L")
    room.write_text(GOOD.replace("room.pgm", "room.png"))
    path = room.with_name("room.png")
    path.write_bytes(path.read_bytes()[:-40])
    with pytest.raises(pf.DataError, match=r"room.png: no sound picture"):
        pf.OccupancyGrid.load(room)
    monkeypatch.setitem(sys.modules, "PIL", None)
    with pytest.raises(pf.DataError, match=r"pip install 'pfkit\[logs\]'"):
        pf.OccupancyGrid.load(room)
