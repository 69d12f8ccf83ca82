# SPDX-License-Identifier: Apache-2.0
"""The pressure filter on n x n equal elements, in row order."""
import numpy as np


def filter_mean(p):
    """A p: the mean over an element's nodes of the nodes' means over their elements."""
    nodes = np.zeros((p.shape[0] + 1, p.shape[1] + 1))
    count = np.zeros_like(nodes)
    corners = [(np.s_[i:i + p.shape[0]], np.s_[j:j + p.shape[1]]) for i in (0, 1) for j in (0, 1)]
    for at in corners:
        nodes[at] += p
        count[at] += 1
    return sum((nodes / count)[at] for at in corners) / 4


def undo_filter(p, strength):
    """The field q with (1 - strength) q + strength A q = p."""
    size = p.size
    matrix = np.stack([(1 - strength) * e + strength * filter_mean(e.reshape(p.shape)).ravel() for e in np.eye(size)], axis=1)
    return np.linalg.solve(matrix, p.ravel()).reshape(p.shape)


def roughness(p):
    """chi: sum |p - A p| / sum |p|."""
    return np.abs(p - filter_mean(p)).sum() / np.abs(p).sum()
