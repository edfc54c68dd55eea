"""Made by tools/lab_tables.py: median over ten seeds and their sd. Do not edit."""

LONG_RUNS = {
    "q9": {
        "what": "modelled sensor variance, px^2",
        "rows": [
            (0.0001, {"mean error, px": [1.29, 0.014], "linear weights": [97.52, 72.096]}),
            (0.01, {"mean error, px": [1.285, 0.015], "linear weights": [3.466, 26.938]}),
            (1.0, {"mean error, px": [0.993, 0.014], "linear weights": [0.978, 0.014]}),
            (100.0, {"mean error, px": [0.486, 0.067], "linear weights": [0.428, 0.054]}),
            (10000.0, {"mean error, px": [1.338, 0.341], "linear weights": [1.109, 0.256]}),
        ],
    },
    "q10": {
        "what": "modelled process variance, px^2",
        "rows": [
            (0.0001, {"mean error, px": [8.528, 3.796], "median error, px": [8.545, 3.802]}),
            (0.01, {"mean error, px": [1.392, 0.764], "median error, px": [0.232, 0.059]}),
            (1.0, {"mean error, px": [0.495, 0.046], "median error, px": [0.378, 0.012]}),
            (100.0, {"mean error, px": [1.109, 0.006], "median error, px": [1.034, 0.016]}),
            (10000.0, {"mean error, px": [2.659, 0.084], "median error, px": [2.404, 0.084]}),
        ],
    },
    "q12": {
        "what": "motion model on the circling target",
        "rows": [
            (
                "fixed",
                {
                    "error with 20 particles, px": [12.358, 0.302],
                    "with 1280": [11.239, 0.037],
                    "particles to come within a tenth of that": [30.0, 10.0],
                },
            ),
            (
                "line",
                {
                    "error with 20 particles, px": [10.273, 2.324],
                    "with 1280": [7.15, 0.052],
                    "particles to come within a tenth of that": [80.0, 76.837],
                },
            ),
            (
                "circle",
                {
                    "error with 20 particles, px": [4.661, 0.575],
                    "with 1280": [3.842, 0.047],
                    "particles to come within a tenth of that": [160.0, 99.679],
                },
            ),
        ],
    },
    "q15": {
        "what": "modelled sensor variance, px^2",
        "rows": [
            (
                0.0001,
                {
                    "rejected of 688, known start": [680.0, 6.928],
                    "rejected of 688, from anywhere": [688.0, 0.0],
                },
            ),
            (
                0.01,
                {
                    "rejected of 688, known start": [26.5, 4.686],
                    "rejected of 688, from anywhere": [688.0, 272.486],
                },
            ),
            (
                1,
                {
                    "rejected of 688, known start": [0.0, 0.0],
                    "rejected of 688, from anywhere": [91.0, 67.538],
                },
            ),
            (
                10,
                {
                    "rejected of 688, known start": [0.0, 0.0],
                    "rejected of 688, from anywhere": [688.0, 0.0],
                },
            ),
            (
                100,
                {
                    "rejected of 688, known start": [0.0, 0.0],
                    "rejected of 688, from anywhere": [688.0, 0.0],
                },
            ),
            (
                1000,
                {
                    "rejected of 688, known start": [0.0, 0.0],
                    "rejected of 688, from anywhere": [688.0, 0.0],
                },
            ),
            (
                2000,
                {
                    "rejected of 688, known start": [688.0, 0.0],
                    "rejected of 688, from anywhere": [688.0, 0.0],
                },
            ),
            (
                10000.0,
                {
                    "rejected of 688, known start": [688.0, 0.0],
                    "rejected of 688, from anywhere": [688.0, 0.0],
                },
            ),
        ],
    },
    "q16": {
        "what": "filter, start",
        "rows": [
            ("naive, anywhere", {"median error, px": [35.963, 1.338]}),
            ("mixture, anywhere", {"median error, px": [0.605, 69.917]}),
            (
                "gate, known start",
                {"median error, px": [0.574, 0.019], "rejected of 688": [340.0, 0.0]},
            ),
            (
                "gate, anywhere",
                {"median error, px": [198.935, 5.124], "rejected of 688": [688.0, 0.0]},
            ),
        ],
    },
}
