"""Kalman's filter against the joint Gaussian of everything, conditioned once."""

import math

import numpy as np
import pytest

import pfkit as pf

F = np.array([[1.0, 0.5], [0.0, 0.9]])
SIGMA_U = np.array([[0.3, 0.1], [0.1, 0.2]])
H = np.array([[1.0, 0.4]])
SIGMA_Z = np.array([[0.5]])
PRIOR = pf.Gaussian((1.0, -1.0), [[2.0, 0.3], [0.3, 1.0]])
SHIFT = np.array([0.2, -0.1])
Z = np.array([0.7, 1.9, 1.1, 0.2])


def joint(T):
    """Mean and covariance of (x_0..x_T, z_1..z_T), by stacking the linear equations."""
    D, n = 2, 1
    A = np.zeros((D * (T + 1) + n * T, D * (T + 1) + n * T))  # y = A noise + b
    b = np.zeros(len(A))
    noise = [PRIOR.Sigma, *[SIGMA_U] * T, *[SIGMA_Z] * T]
    A[:D, :D], b[:D] = np.eye(D), PRIOR.mean
    for t in range(1, T + 1):
        rows, before = slice(D * t, D * t + D), slice(D * t - D, D * t)
        A[rows], b[rows] = F @ A[before], F @ b[before] + SHIFT
        A[rows, rows] += np.eye(D)
        z = D * (T + 1) + t - 1
        A[z], b[z] = (H @ A[rows])[0], (H @ b[rows])[0]
        A[z, z] += 1
    N = np.zeros_like(A)
    at = 0
    for block in noise:
        N[at : at + len(block), at : at + len(block)] = block
        at += len(block)
    return b, A @ N @ A.T


def log_normal(x, mean, Sigma):
    e = x - mean
    return -0.5 * (e @ np.linalg.solve(Sigma, e) + np.linalg.slogdet(2 * math.pi * Sigma)[1])


def test_filter_and_evidence_equal_one_big_conditioning():
    T = len(Z)
    b, S = joint(T)
    zs, last = slice(2 * (T + 1), None), slice(2 * T, 2 * T + 2)
    gain = S[last, zs] @ np.linalg.inv(S[zs, zs])
    bel, log_evidence = PRIOR, 0.0
    for z in Z:
        bel = pf.kalman_predict(bel, F, SIGMA_U, SHIFT)
        bel, e, rejected = pf.kalman_update(bel, [z], H, SIGMA_Z)
        assert not rejected
        log_evidence += e
    np.testing.assert_allclose(bel.mean, b[last] + gain @ (Z - b[zs]))
    np.testing.assert_allclose(bel.Sigma, S[last, last] - gain @ S[zs, last])
    assert log_evidence == pytest.approx(log_normal(Z, b[zs], S[zs, zs]))


def test_gate_rejects_what_is_too_far_and_changes_nothing():
    S = (H @ PRIOR.Sigma @ H.T + SIGMA_Z)[0, 0]
    expected = (H @ PRIOR.mean)[0]
    for sigmas, out in ((2.5, False), (2.7, True)):
        z = expected + sigmas * math.sqrt(S)
        bel, log_evidence, rejected = pf.kalman_update(PRIOR, [z], H, SIGMA_Z, gate=6.63)
        assert rejected is out
        assert (bel is PRIOR) is out and (log_evidence == 0) is out


def test_deviations_may_stand_for_a_covariance():
    np.testing.assert_allclose(pf.Gaussian((0, 0), (0.5, 2.0)).Sigma, np.diag((0.25, 4.0)))


@pytest.mark.parametrize(
    "call, error",
    [
        (lambda: pf.Gaussian((0, 0), np.eye(3)), pf.ShapeError),
        (lambda: pf.Gaussian(np.zeros((2, 2)), np.eye(2)), pf.ShapeError),
        (lambda: pf.Gaussian((0, np.nan), np.eye(2)), pf.ParameterError),
        (lambda: pf.Gaussian((0, 0), [[1, 2], [2, 1]]), pf.ParameterError),
        (lambda: pf.Gaussian((0, 0), [[1, 0.5], [0, 1]]), pf.ParameterError),
        (lambda: pf.Gaussian((0, 0), (-1, 1)), pf.ParameterError),
        (lambda: pf.Gaussian([], []), pf.ShapeError),
        (lambda: pf.kalman_predict(PRIOR, np.eye(3), SIGMA_U), ValueError),
        (lambda: pf.kalman_predict(PRIOR, F, -0.1 * np.eye(len(F))), pf.ParameterError),
        (lambda: pf.kalman_update(PRIOR, [1.0], H, [[-9.0]]), pf.ParameterError),
        (
            lambda: pf.kalman_update(pf.Gaussian((0, 0), (0, 0)), [1.0], [[1, 0]], [[0.0]]),
            np.linalg.LinAlgError,
        ),
        (lambda: pf.kalman_predict(PRIOR, F, np.eye(1)), pf.ShapeError),
        (lambda: pf.kalman_update(PRIOR, [1.0, 2.0], H, SIGMA_Z), pf.ShapeError),
        (lambda: pf.kalman_update(PRIOR, [1.0], H, np.eye(2)), pf.ShapeError),
        (lambda: pf.kalman_update(PRIOR, [np.inf], H, SIGMA_Z), pf.ParameterError),
    ],
)
def test_bad_input_is_named(call, error):
    with pytest.raises(error):
        call()
