"""The controls of `pfkit.explore.drive`, and its panels: one for each chapter that uses it."""

from __future__ import annotations

from pfkit.explore.scene import Control, Mission, Panel, Score

SCHEMES = (
    ("systematic", "systematic"),
    ("stratified", "stratified"),
    ("residual", "residual"),
    ("multinomial", "multinomial"),
)
CONTROLS = (
    Control(
        "M",
        "Particles M",
        "range",
        500,
        lo=10,
        hi=20000,
        step=10,
        log=True,
        live=False,
        help="A new number restarts the run.",
    ),
    Control(
        "prior",
        "At the start",
        "choice",
        "lost",
        choices=(("lost", "lost"), ("known", "pose known")),
        live=False,
        help="Lost: particles anywhere in the arena.",
    ),
    Control(
        "sense",
        "The robot measures",
        "choice",
        "both",
        choices=(("both", "both"), ("range", "range"), ("bearing", "bearing")),
        help="Range, bearing, or both, to every landmark in sight.",
    ),
    Control(
        "sigma_r",
        "Range noise σ_r",
        "range",
        0.3,
        lo=0.05,
        hi=2,
        step=0.05,
        unit="m",
        help="Standard deviation, of the robot and in the filter's model.",
    ),
    Control(
        "sigma_phi",
        "Bearing noise σ_φ",
        "range",
        6,
        lo=1,
        hi=40,
        step=1,
        unit="°",
        help="Standard deviation, of the robot and in the filter's model.",
    ),
    Control(
        "sight",
        "FieldOfView",
        "range",
        5.0,
        lo=1,
        hi=22,
        step=0.5,
        unit="m",
        help="How far away a landmark can be measured.",
    ),
    Control(
        "noise",
        "Motion noise",
        "range",
        1.0,
        lo=0,
        hi=4,
        step=0.1,
        unit="×",
        help="How badly the robot carries out what it is told.",
    ),
    Control(
        "trust",
        "Filter's idea of it",
        "range",
        1.0,
        lo=0,
        hi=4,
        step=0.1,
        unit="×",
        help="Above 1 the filter expects more motion noise than there is.",
    ),
    Control(
        "scheme",
        "Resampling",
        "choice",
        "systematic",
        choices=SCHEMES,
        help="The scheme that turns weights into copies.",
    ),
    Control(
        "threshold",
        "Resample when ESS/M below",
        "range",
        0.5,
        lo=0,
        hi=1,
        step=0.05,
        help="0 never, 1 after every reading.",
    ),
    Control(
        "fresh",
        "Fresh particles",
        "range",
        0,
        lo=0,
        hi=20,
        step=1,
        unit="%",
        help="Share drawn anywhere at each resampling: insurance against a kidnap.",
    ),
    Control(
        "kidnap", "Kidnap the robot", "button", help="Puts it elsewhere, untold.", keys={"k": True}
    ),
    Control(
        "autopilot",
        "Autopilot",
        "toggle",
        True,
        help="Off, the robot waits for you: arrow keys, or press on the floor.",
    ),
    Control("add", "Add a landmark", "button", help="Somewhere.", keys={"a": True}),
    Control(
        "remove", "Remove it", "button", help="The one you held last; one stays.", keys={"d": True}
    ),
    Control("fifth", "Put up a fifth landmark", "button", help="At (13, 7.5)."),
    Control(
        "throttle",
        "Forward",
        "range",
        0.0,
        lo=-1,
        hi=1,
        step=0.1,
        keys={"ArrowUp": 1.0, "ArrowDown": -0.7},
        help="Hold the up or down arrow key, or leave the slider off zero.",
    ),
    Control(
        "steer",
        "Turn left",
        "range",
        0.0,
        lo=-1,
        hi=1,
        step=0.1,
        keys={"ArrowLeft": 1.0, "ArrowRight": -1.0},
        help="Hold the left or right arrow key.",
    ),
    Control("do_predict", "Prediction noise", "toggle", True, help="Each particle errs by itself."),
    Control("do_weigh", "Weighting", "toggle", True, help="Multiply by the likelihood."),
    Control("do_resample", "Resampling", "toggle", True, help="Turn weights into copies."),
    Control(
        "outliers",
        "False readings",
        "range",
        0,
        lo=0,
        hi=60,
        step=1,
        unit="%",
        help="Each reading is replaced by nonsense with this probability.",
    ),
    Control(
        "defence",
        "The filter's defence",
        "choice",
        "none",
        choices=(("none", "none"), ("gate", "gate"), ("mixture", "mixture")),
        help="Believe all, reject what no particle explains, or allow for nonsense.",
    ),
    Control(
        "gate",
        "Gate log₁₀ λ",
        "range",
        -3,
        lo=-8,
        hi=1,
        step=0.5,
        help="A reading whose mean density is below 10^this is ignored.",
    ),
    Control(
        "epsilon",
        "Mixture ε",
        "range",
        20,
        lo=0,
        hi=80,
        step=1,
        unit="%",
        help="The share of nonsense that the mixture expects.",
    ),
    Control(
        "names",
        "Landmarks have names",
        "toggle",
        True,
        help="Off, each particle picks the landmark that fits best.",
    ),
    # Fixed by the panel; no reader sees them.
    Control(
        "world", "World", "choice", "arena", choices=(("arena", ""), ("pair", ""), ("square", ""))
    ),
    Control(
        "show", "Show", "choice", "cloud", choices=(("cloud", ""), ("copies", ""), ("map", ""))
    ),
    Control("moves", "Moves", "toggle", True),
)
HANDS = ("autopilot", "throttle", "steer")
LATE = Score("error", 1200, 1.0)  # lost or not, after twenty seconds


def _found(s) -> bool:
    return s.error < 0.3 and s.spread < 0.6


def _sure_and_wrong(s) -> bool:
    return s.error > 2 and s.spread < 0.5 and s.ticks > 300


def _off(switch: bool) -> bool:
    return not switch


PANELS = {
    "localise": Panel(
        "Drive and localise",
        ("kidnap", "M", "fresh", "sense", "sigma_r"),
        ("prior", "sigma_phi", "sight", "noise", "scheme", "threshold", *HANDS),
        score=LATE,
        missions=(
            Mission(
                "found",
                "Start lost and let the autopilot drive until the ellipse closes on the robot. "
                "How many landmarks did it need to see?",
                lambda s: s.values["prior"] == "lost" and _found(s),
            ),
            Mission(
                "fifty particles",
                "Take 50 particles and try new seeds until the filter is sure and wrong: a small "
                "ellipse, metres from the robot. Does it recover?",
                lambda s: s.values["M"] <= 60 and _sure_and_wrong(s),
            ),
            Mission(
                "found after a kidnap",
                "Kidnap the robot when the filter has found it. Then give it 5 % fresh particles "
                "and kidnap again: time the recovery.",
                lambda s: s.kidnapped and s.values["fresh"] > 0 and _found(s),
            ),
        ),
        alt="A robot drives through an arena with four numbered landmarks. A cloud of particles, "
        "its mean and two-sigma ellipse follow the robot. Two strip charts show the effective "
        "share of the particles and the position error over the last seconds.",
    ),
    "sensing": Panel(
        "What one look says about the position",
        ("sense", "sigma_r", "sigma_phi", "add", "remove"),
        ("sight", *HANDS),
        values={"show": "map", "world": "pair", "sense": "range", "sight": 12.0, "sigma_r": 0.4},
        missions=(
            Mission(
                "one landmark",
                "Choose range only and remove landmarks until one is left. What shape is the "
                "likelihood? With two, where are its peaks?",
                lambda s: s.values["sense"] == "range" and s.landmarks.shape[1] == 1,
            ),
            Mission(
                "a right angle",
                "With two landmarks and bearings only, drag them until the likely area is as "
                "small as you can make it. Which angle between them is best?",
                lambda s: s.values["sense"] == "bearing"
                and s.landmarks.shape[1] == 2
                and s.readouts()["likely area"] < 0.6,
            ),
            Mission(
                "twice the noise",
                "Double the range noise. By what factor does the likely area grow with one "
                "landmark, and with four? Why not by the same?",
                lambda s: s.values["sigma_r"] >= 0.8 and s.landmarks.shape[1] >= 4,
            ),
        ),
        alt="The likelihood of one look over all positions of the arena, as shading, with the "
        "robot and the landmarks that shape it.",
    ),
    "assembly": Panel(
        "Take the filter apart",
        ("do_predict", "do_weigh", "do_resample", "M", "threshold"),
        ("prior", "noise", *HANDS),
        score=LATE,
        missions=(
            Mission(
                "no resampling",
                "Let the filter settle, then switch resampling off. Watch the largest dot. How "
                "many steps until the ESS is below 10?",
                lambda s: not s.values["do_resample"] and s.ess < 10,
            ),
            Mission(
                "no prediction noise",
                "Switch resampling on again and prediction noise off. The ESS looks healthy. What "
                "does the error do after a few laps, and what do the dots look like?",
                lambda s: (
                    s.values["do_resample"] and not s.values["do_predict"] and s.spread < 0.02
                ),
            ),
            Mission(
                "no weighting",
                "Switch weighting off for one lap, then on. Can the cloud find its way back? Try "
                "again with 100 particles.",
                lambda s: s.values["do_weigh"] and s.spent("do_weigh", _off) >= 400,
            ),
        ),
        alt="The robot, its cloud and the filter's mean, with three switches: prediction noise, "
        "weighting, resampling.",
    ),
    "outliers": Panel(
        "False readings",
        ("outliers", "defence", "gate", "epsilon", "kidnap"),
        ("M", "prior", "sigma_r", *HANDS),
        score=LATE,
        values={"outliers": 20, "prior": "known", "sight": 6.0},
        missions=(
            Mission(
                "lost",
                "No gate, no mixture: raise the share of false readings. At which share does the "
                "cloud lose the robot?",
                lambda s: (
                    s.values["defence"] == "none" and s.values["outliers"] > 20 and s.error > 1.5
                ),
            ),
            Mission(
                "two wrong shares",
                "Switch the mixture on, and set its share ε far too low and far too high. Which "
                "error costs more?",
                lambda s: (
                    s.values["defence"] == "mixture"
                    and s.spent("epsilon", lambda share: share <= 2) >= 120
                    and s.spent("epsilon", lambda share: share >= 60) >= 120
                ),
            ),
            Mission(
                "shut gate",
                "Switch to the gate, kidnap the robot, and wait. Does the filter ever accept a "
                "measurement again?",
                lambda s: (
                    s.values["defence"] == "gate"
                    and s.kidnapped
                    and s.counts["rejected"] >= s.rejected_before + 10
                ),
            ),
        ),
        alt="The robot in the arena; false readings appear as red beams that end in a cross. The "
        "filter defends itself by a gate or a mixture, or not at all.",
    ),
    "symmetry": Panel(
        "Four places that look the same",
        ("fifth", "M", "scheme", "noise", "names"),
        ("threshold", "trust", "sigma_r", *HANDS),
        score=Score("error", 1200, 3.0),
        values={"world": "square", "show": "copies", "names": False, "sight": 22.0, "M": 2000,
                "sigma_r": 1.0, "sigma_phi": 20.0, "threshold": 0.7},
        record=(400, 16),
        missions=(
            Mission(
                "hypotheses die",
                "Wait until fewer than four hypotheses are alive. Nothing the robot saw told them "
                "apart. What did?",
                lambda s: s.most_alive == 4 and s.alive < 4,
            ),
            Mission(
                "two schemes",
                "Take 10,000 particles and compare systematic with multinomial. Which keeps more "
                "for longer, and is one run each enough to say so?",
                lambda s: (
                    s.values["M"] >= 5000
                    and min(s.spent("scheme", k.__eq__) for k in ("systematic", "multinomial"))
                    >= 200
                ),
            ),
            Mission(
                "fifth landmark",
                "Put up the fifth landmark while several clouds are alive, and again when only one "
                "is left. When does it help, and when does it hurt?",
                lambda s: s.landmarks.shape[1] == 5 and s.masses()[0] > 0.9,
            ),
        ),
        alt="A square of four landmarks without names. Dashed circles mark the three places that "
        "look the same as the robot's; the cloud sits in up to four clusters.",
    ),
    "kidnap": Panel(
        "Kidnapped",
        ("kidnap", "fresh", "M", "sense", "threshold"),
        ("sigma_r", "sigma_phi", "sight", "scheme", *HANDS),
        values={"prior": "known"},
        score=Score("error", 900, 1.0, moves=((300, "kidnap", True),)),
        missions=(
            Mission(
                "never unsure",
                "Kidnap the robot without fresh particles. Is the filter ever unsure?",
                lambda s: s.kidnapped and s.values["fresh"] == 0 and _sure_and_wrong(s),
            ),
            Mission(
                "small insurance",
                "Find the smallest share of fresh particles that recovers within five seconds.",
                lambda s: s.kidnapped and 0 < s.values["fresh"] <= 5 and _found(s),
            ),
            Mission(
                "price of insurance",
                "Without a kidnap, what do 20 % fresh particles cost in error and spread?",
                lambda s: not s.kidnapped and s.spent("fresh", lambda share: share >= 20) >= 300,
            ),
        ),
        alt="The robot is carried to another place and the cloud stays behind; fresh particles "
        "scattered over the arena let the filter find it again.",
    ),
}  # fmt: skip
