"""The two short logs on which the experiments of *A real robot* run, in a page as well."""

from __future__ import annotations

import json
from functools import cache
from importlib.resources import files

import numpy as np

import pfkit as pf
from pfkit.explore.mower import recorded


def minute():
    """The first minute of Plaza 2, one step for each range (packed, so that it runs in a page)."""
    log = recorded()["log"]
    return log[: int(np.searchsorted(log.t, 60.0))]


@cache
def stretch():
    """Ten seconds of the twin, one step for each picture; no start is known."""
    raw = json.loads(files("pfkit.labs").joinpath("real_robot_stretch.json").read_text("ascii"))
    world = pf.LandmarkMap(np.array(raw["landmarks"]), raw["ids"], raw["bounds"])
    z = [np.array(zk).reshape(3, -1) for zk in raw["z"]]
    return pf.Log(np.array(raw["t"]), np.array(raw["u"]), z, np.array(raw["truth"]), world=world)
