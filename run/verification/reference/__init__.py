# SPDX-License-Identifier: Apache-2.0
"""Exact solutions, made here from first principles and independent of the programs: Riemann problems of Mie-Grueneisen gases, pistons,
detonation waves, the ring, and the impulse of a travelling front. SI units; pressure positive in compression."""
from .eos import *  # noqa: F401, F403
from .waves import *  # noqa: F401, F403
from .pistons import *  # noqa: F401, F403
from .detonation import *  # noqa: F401, F403
from .blast import *  # noqa: F401, F403
from .solid import *  # noqa: F401, F403
from .solid_filter import *  # noqa: F401, F403
