# SPDX-License-Identifier: Apache-2.0
"""A row of run/bench."""


def row(name, value, unit, threads=1, ranks=1):
    return dict(name=name, value=float(value), unit=unit, threads=threads, ranks=ranks)
