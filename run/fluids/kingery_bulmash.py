# SPDX-License-Identifier: Apache-2.0
"""Air blast of TNT at sea level: the curves of C. Kingery and G. Bulmash, "Airblast parameters from TNT spherical air burst and hemispherical
surface burst", ARBRL-TR-02555, 1984: log10 Y = sum c_i U^i, U = K0 + K1 log10 Z, Z = distance over the cube root of the charge
[m/kg^(1/3)]; Y in kPa, kPa ms/kg^(1/3), ms/kg^(1/3). The coefficients are those of csd/load/kingery_bulmash.h, which says where public
copies differ; a test compares the two.
"""
import numpy as np

FARTHEST = 40.0  # m/kg^(1/3)
FREE_AIR = {  # nearest: shortest Z of the curves; shortest: of the durations, which are as there if nearer
    "nearest": .0531, "shortest": .147,
    "incident": [  # up to Z, K0, K1, c
        (40, -.214362789151, 1.35034249993, [2.611368669, -1.69012801396, .00804973591951, .336743114941, -.00516226351334,
            -.0809228619888, -.00478507266747, .00793030472242, .0007684469735]),
    ],
    "reflected": [  # up to Z, K0, K1, c
        (40, -.214362789151, 1.35034249993, [3.22958031387, -2.21400538997, .035119031446, .657599992109, .0141818951887, -.243076636231,
            -.0158699803158, .0492741184234, .00227639644004, -.00397126276058]),
    ],
    "incident_impulse": [  # up to Z, K0, K1, c
        (.792, 2.34723921354, 3.24299066475, [2.38830516757, -.443749377691, .168825414684, .0348138030308, -.010435192824]),
        (40, -1.75305660315, 2.30629231803, [1.55197227115, -.40463292088, -.0142721946082, .00912366316617, -.0006750681404,
            -.00800863718901, .00314819515931, .00152044783382, -.0007470265899]),
    ],
    "reflected_impulse": [  # up to Z, K0, K1, c
        (40, -.204004553231, 1.37882996018, [2.55875660396, -.903118886091, .101771877942, -.0242139751146]),
    ],
    "arrival": [  # up to Z, K0, K1, c
        (40, -.253273111999, 1.37407043777, [.0720707787637, 1.36456871214, -.0570035692784, -.182832224796, .0118851436014,
            .0432648687627, -.0007997367834, -.00436073555033]),
    ],
    "duration": [  # up to Z, K0, K1, c
        (.888, 2.26367268496, 5.11588554305, [-.686608550419, .164953518069, .127788499497, .00291430135946, .00187957449227,
            .0173413962543, .00269739758043, -.00361976502798, -.00100926577934]),
        (2.28, -1.33361206714, 9.2996288611, [.23031841078, -.0297944268969, .0306329542941, .0183405574074, -.0173964666286,
            -.00106321963576, .0056206003128, .0001618217499, -.0006860188944]),
        (40, -3.13005805346, 3.1524725364, [.621036276475, .0967031995552, -.00801302059667, .00482705779732, .00187587272287,
            -.00246738509321, -.000841116668, .0006193291052]),
    ],
}
HEMISPHERE = {  # nearest: shortest Z of the curves; shortest: of the durations, which are as there if nearer
    "nearest": .0674, "shortest": .178,
    "incident": [  # up to Z, K0, K1, c
        (40, -.214362789151, 1.35034249993, [2.78076916577, -1.6958988741, -.154159376846, .514060730593, .0988534365274, -.293912623038,
            -.0268112345019, .109097496421, .00162846756311, -.0214631030242, .0001456723382, .00167847752266]),
    ],
    "reflected": [  # up to Z, K0, K1, c
        (40, -.240657322658, 1.36637719229, [3.40283217581, -2.21030870597, -.218536586295, .895319589372, .24989009775, -.569249436807,
            -.11791682383, .224131161411, .0245620259375, -.0455116002694, -.00190930738887, .00361471193389]),
    ],
    "incident_impulse": [  # up to Z, K0, K1, c
        (.955, 2.06761908721, 3.0760329666, [2.52455620925, -.502992763686, .171335645235, .0450176963051, -.0118964626402]),
        (40, -1.94708846747, 2.40697745406, [1.67281645863, -.384519026965, -.0260816706301, .00595798753822, .0145445261077,
            -.00663289334734, -.00284189327204, .0013644816227]),
    ],
    "reflected_impulse": [  # up to Z, K0, K1, c
        (40, -.246208804814, 1.33422049854, [2.70588058103, -.949516092853, .112136118689, -.0250659183287]),
    ],
    "arrival": [  # up to Z, K0, K1, c
        (40, -.202425716178, 1.37784223635, [-.0591634288046, 1.35706496258, .052492798645, -.196563954086, -.0601770052288,
            .0696360270891, .0215297490092, -.0161658930785, -.00232531970294, .00147752067524]),
    ],
    "duration": [  # up to Z, K0, K1, c
        (1.01, 1.92946154068, 5.25099193925, [-.614227603559, .130143717675, .134872511954, .0391574276906, -.00475933664702,
            -.00428144598008]),
        (2.78, -2.12492525216, 9.2996288611, [.315409245784, -.0297944268976, .030632954288, .0183405574086, -.0173964666211,
            -.00106321963633, .00562060030977, .0001618217499, -.0006860188944]),
        (40, -3.53626218091, 3.46349745571, [.686906642409, .0933035304009, -.0005849420883, -.00226884995013, -.00295908591505,
            .00148029868929]),
    ],
}


def curve(ranges, Z):
    """Value of a curve at the scaled distances Z [m/kg^(1/3)]."""
    Z = np.asarray(Z, dtype=float)
    result = np.full(Z.shape, np.nan)
    for i, (up_to, k0, k1, c) in enumerate(ranges):
        here = np.isnan(result) & ((Z <= up_to) | (i + 1 == len(ranges)))
        result[here] = 10.0 ** np.polynomial.polynomial.polyval(k0 + k1 * np.log10(Z[here]), c)
    return result


def decay(impulse, peak, duration):
    """b of p = P (1 - s) exp(-b s), s = t/T, whose impulse is P T (1/b - (1 - exp(-b))/b^2); 0 where that is more than the triangle's."""
    share = impulse / (peak * duration)

    def of(b):
        b = np.maximum(b, 1e-4)
        return (1 - (1 - np.exp(-b)) / b) / b
    low, high = np.zeros_like(share), np.full_like(share, 1e4)
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = np.where(of(middle) > share, middle, low), np.where(of(middle) > share, high, middle)
    return np.where(share >= 0.5, 0.0, 0.5 * (low + high))


def friedlander(s, b):
    """(1 - s) exp(-b s) within 0 <= s < 1, else 0."""
    return np.where((s >= 0) & (s < 1), (1 - s) * np.exp(-b * np.clip(s, 0, 1)), 0.0)


def friedlander_integral(s, b):
    """Integral of that from 0 to s."""
    s = np.clip(s, 0, 1)
    large = np.maximum(b, 1e-3)
    gone = np.exp(-large * s)
    return np.where(b < 1e-3, s - s * s / 2 - b * (s * s / 2 - s ** 3 / 3), (1 - gone) / large - (1 - gone * (1 + large * s)) / large ** 2)


class Wave:
    """The wave at places [n] at `distance` [m] from `charge` [kg of TNT]: Pa, s. Distances are taken as within the curves' range."""

    def __init__(self, curves, distance, charge):
        root = np.cbrt(charge)
        Z = np.clip(distance / root, curves["nearest"], FARTHEST)
        self.incident, self.reflected = 1e3 * curve(curves["incident"], Z), 1e3 * curve(curves["reflected"], Z)
        self.arrival = 1e-3 * root * curve(curves["arrival"], Z)
        self.duration = 1e-3 * root * curve(curves["duration"], np.maximum(Z, curves["shortest"]))
        self.incident_decay = decay(root * curve(curves["incident_impulse"], Z), self.incident, self.duration)
        self.reflected_decay = decay(root * curve(curves["reflected_impulse"], Z), self.reflected, self.duration)

    def _mixed(self, side_on, head_on, cosine):
        """Angle of incidence [G. Randers-Pehrson, K. Bannister, ARL-TR-1310, 1997]; cosine 1: head on, <= 0: the face looks away."""
        c = np.maximum(cosine, 0)
        return side_on * (1 + c - 2 * c * c) + head_on * c * c

    def pressure(self, cosine, t):
        """Overpressure at t [Pa]."""
        s = (t - self.arrival) / self.duration
        return self._mixed(self.incident * friedlander(s, self.incident_decay), self.reflected * friedlander(s, self.reflected_decay), cosine)

    def mean_pressure(self, cosine, t0, t1):
        """Mean overpressure from t0 to t1 [Pa]: the impulse is exact whatever the window."""
        s0, s1 = (t0 - self.arrival) / self.duration, (t1 - self.arrival) / self.duration
        share = self.duration / (t1 - t0)

        def mean(peak, b):
            return peak * share * (friedlander_integral(s1, b) - friedlander_integral(s0, b))
        return self._mixed(mean(self.incident, self.incident_decay), mean(self.reflected, self.reflected_decay), cosine)
