# SPDX-License-Identifier: Apache-2.0
"""Cases of the pair."""
import sys

from . import reference
from .case import ROOT, at_most, case, close, run

sys.path.insert(0, str(ROOT / "run"))
import fields  # noqa: E402
