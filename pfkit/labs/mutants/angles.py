"""Angles averaged, compared or inverted as if they were plain numbers."""

import numpy as np

from pfkit.labs.items import Misconception


def arithmetic_mean(theta, w):
    return np.sum(w * theta) / np.sum(w)


def arctan_of_the_ratio(theta, w):
    return np.arctan(np.sum(w * np.sin(theta)) / np.sum(w * np.cos(theta)))


def without_weights(theta, w):
    return np.arctan2(np.sin(theta).mean(), np.cos(theta).mean())


def swapped_arguments(theta, w):
    return np.arctan2(np.sum(w * np.cos(theta)), np.sum(w * np.sin(theta)))


def in_degrees(theta, w):
    t = np.deg2rad(theta)
    return np.rad2deg(np.arctan2(np.sum(w * np.sin(t)), np.sum(w * np.cos(t))))


def _as_degrees(mean):
    """Are degrees taken for radians on the way in, on the way out, or both?"""
    theta, w = np.array([0.4, 0.9, 2.0]), np.array([0.2, 0.5, 0.3])
    right = np.arctan2(np.sum(w * np.sin(theta)), np.sum(w * np.cos(theta)))
    both = in_degrees(theta, w)
    return any(np.isclose(mean(theta, w), x) for x in (both, np.deg2rad(both), np.rad2deg(right)))


CIRCULAR_MEAN = (
    Misconception(
        "arithmetic-mean",
        "averages the angles as plain numbers",
        (
            "Try it on 3.1 and -3.1 rad. Which way do these two headings point?",
            "Add arrows, not numbers: each angle is an arrow (cos, sin).",
            "Sum w cos and w sin over the set, and return arctan2(sum of sines, sum of cosines).",
        ),
        arithmetic_mean,
    ),
    Misconception(
        "arctan",
        "behaves like arctan of a ratio, which knows only half of the circle",
        (
            "Try it on a set of headings that all point to the left, such as 3.0 rad.",
            "A ratio forgets the signs of its two parts: (-1)/(-1) equals 1/1.",
            "Give both parts to arctan2(sine, cosine), which keeps the quadrant.",
        ),
        arctan_of_the_ratio,
    ),
    Misconception(
        "no-weights",
        "gives every particle the same say: the weights are not used",
        (
            "What should the mean be if one particle holds all the weight?",
            "The arrow of a particle is as long as its weight.",
            "Multiply sines and cosines by w before you sum.",
        ),
        without_weights,
    ),
    Misconception(
        "swapped-arguments",
        "passes the cosine first to arctan2",
        (
            "What is your mean of the single heading 0?",
            "arctan2 takes y first, then x.",
            "Write arctan2(sum of sines, sum of cosines).",
        ),
        swapped_arguments,
    ),
    Misconception(
        "degrees",
        "treats the angles as degrees",
        (
            "All angles of this course are in radians.",
            "np.sin and np.cos take radians already: no conversion is needed.",
            "Remove deg2rad and rad2deg.",
        ),
        in_degrees,
        _as_degrees,
    ),
)

MUTANTS = {"lab3": {"p5b": CIRCULAR_MEAN}}
