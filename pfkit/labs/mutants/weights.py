"""Importance weights upside down, forgotten, or kept where they should be reset."""

import numpy as np

from pfkit.labs.items import Misconception


def inverse_ratio(values, target, proposal):
    w = proposal / target
    return np.sum(w * values) / np.sum(w)


def target_only(values, target, proposal):
    return np.sum(target * values) / np.sum(target)


def plain_mean(values, target, proposal):
    return np.mean(values)


def not_normalised(values, target, proposal):
    return np.mean(target / proposal * values)


def mean_weight(values, target, proposal):
    return np.mean(target / proposal)


ESTIMATE = (
    Misconception(
        "mean-weight",
        "averages the weights and forgets the values",
        (
            "Shift all values by 10. What should happen to the estimate?",
            "A weight says how much a value counts; the value must appear, too.",
            "Return sum(w * values) / sum(w).",
        ),
        mean_weight,
    ),
    Misconception(
        "inverse-ratio",
        "divides the proposal by the target: the weights are upside down",
        (
            "A value that the proposal draws too seldom must count more, not less.",
            "Check one sample: target .5, proposal .2. Should it weigh 2.5 or .4?",
            "The weight is target / proposal.",
        ),
        inverse_ratio,
    ),
    Misconception(
        "target-only",
        "weighs by the target alone",
        (
            "The samples are already dense where the proposal is high. Is that counted twice?",
            "The weight corrects for how the samples were drawn, so the proposal appears in it.",
            "The weight is target / proposal.",
        ),
        target_only,
    ),
    Misconception(
        "plain-mean",
        "is the plain mean of the samples",
        (
            "The samples come from the proposal, so their plain mean is the mean of the proposal.",
            "Weigh each sample by how much more the target wants it than the proposal gives it.",
            "Return sum(w * values) / sum(w) with w = target / proposal.",
        ),
        plain_mean,
    ),
    Misconception(
        "not-normalised",
        "does not divide by the sum of the weights",
        (
            "Multiply the target by 7. The estimate should not change.",
            "In a filter we know the target only up to a constant.",
            "Divide by sum(w), not by the number of samples.",
        ),
        not_normalised,
    ),
)


def weights_kept(state, w, ancestors):
    return state[:, ancestors], w


def weights_carried(state, w, ancestors):
    kept = w[ancestors]
    return state[:, ancestors], kept / kept.sum()


def weights_one(state, w, ancestors):
    return state[:, ancestors], np.ones(len(ancestors))


def states_kept(state, w, ancestors):
    return state, np.full(len(ancestors), 1 / len(ancestors))


def old_number(state, w, ancestors):
    return state[:, ancestors], np.full(len(ancestors), 1 / len(w))


SELECT = (
    Misconception(
        "old-number",
        "divides by the number of old particles, not of new ones",
        (
            "Draw 3 ancestors of 5 particles. Do your 3 weights sum to 1?",
            "n is the number of ancestors.",
            "np.full(len(ancestors), 1 / len(ancestors)).",
        ),
        old_number,
    ),
    Misconception(
        "weights-kept",
        "keeps the old weights after resampling",
        (
            "Resampling turned weight into copies. What would the old weights count again?",
            "Each copy now stands for the same share of the belief.",
            "After resampling n particles, every weight is 1/n.",
        ),
        weights_kept,
    ),
    Misconception(
        "weights-carried",
        "lets each copy carry the weight of its ancestor",
        (
            "A particle of weight .4 became two of five copies. Which share do they have together?",
            "Number of copies times weight of a copy must give the old weight, on average.",
            "After resampling n particles, every weight is 1/n.",
        ),
        weights_carried,
    ),
    Misconception(
        "weights-one",
        "sets all weights to 1",
        (
            "Weights of a belief sum to one. Yours sum to the number of particles.",
            "Equal is right; now normalise.",
            "After resampling n particles, every weight is 1/n.",
        ),
        weights_one,
    ),
    Misconception(
        "states-kept",
        "resets the weights but does not copy the states",
        (
            "Compare the states before and after. Who survived?",
            "The ancestors are column numbers of the state array.",
            "Index the columns: state[:, ancestors].",
        ),
        states_kept,
    ),
)


def exp_underflows(log_l):
    w = np.exp(log_l)
    return w / w.sum()


def all_zero_all_equal(log_l):
    w = np.exp(log_l)
    return w / w.sum() if w.sum() > 0 else np.full(len(w), 1 / len(w))


def best_is_one(log_l):
    return np.exp(log_l - np.max(log_l))


def logs_as_weights(log_l):
    return log_l / np.sum(log_l)


def wrong_sign(log_l):
    w = np.exp(np.min(log_l) - log_l)
    return w / w.sum()


FROM_LOGS = (
    Misconception(
        "underflow",
        "divides 0 by 0 where all likelihoods underflow",
        (
            "What is np.exp(-20000)? And the sum of such numbers?",
            "Only differences between the logarithms matter.",
            "Subtract the largest logarithm before you take exp.",
        ),
        exp_underflows,
    ),
    Misconception(
        "all-equal",
        "makes all weights equal where all likelihoods underflow: the measurement is forgotten",
        (
            "One of four particles is 16 times as likely as another. Do yours show it far away?",
            "That repair hides the underflow; it does not undo it.",
            "Subtract the largest logarithm before you take exp.",
        ),
        all_zero_all_equal,
    ),
    Misconception(
        "not-normalised",
        "gives the best particle the weight 1 and does not normalise",
        (
            "What do your weights sum to?",
            "Subtracting the maximum is the first half of the work.",
            "Divide by w.sum().",
        ),
        best_is_one,
    ),
    Misconception(
        "logarithms",
        "normalises the logarithms themselves",
        (
            "Your least likely particle has the largest weight.",
            "A weight is proportional to the likelihood, not to its logarithm.",
            "Take exp first, then divide by the sum.",
        ),
        logs_as_weights,
    ),
    Misconception(
        "sign",
        "has the sign of the exponent wrong",
        (
            "Which particle has the largest log-likelihood, and which the largest weight?",
            "The likelihood is exp(log_l), not exp(-log_l).",
            "w = np.exp(log_l - log_l.max()).",
        ),
        wrong_sign,
    ),
)

MUTANTS = {"lab3": {"p2b": ESTIMATE, "q3d": FROM_LOGS, "q4d": SELECT}}
