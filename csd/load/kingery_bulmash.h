// SPDX-License-Identifier: Apache-2.0
// Air blast of TNT at sea level: the curves of C. Kingery and G. Bulmash, "Airblast parameters from TNT spherical air
// burst and hemispherical surface burst", ARBRL-TR-02555, 1984. log10 Y = sum c_i U^i, U = K0 + K1 log10 Z, Z =
// distance over the cube root of the charge [m/kg^(1/3)]; Y in kPa, kPa ms/kg^(1/3), ms/kg^(1/3).
//
// Copies of the coefficients in public codes differ in single digits and signs. Taken here is what closes the gaps
// between the ranges of a curve (signs in the second and third range of the free-air duration and the third of the
// hemispherical one) and follows the reflection of a plane shock (reflected pressure); a unit test holds both.
#pragma once
#include <cmath>
#include <span>

namespace bw::csd {

/// One range of a curve.
struct BlastCurve {
  double up_to;  ///< m/kg^(1/3)
  double k0, k1;
  int count;
  double c[12];

  double at(double Z) const {
    const double u = k0 + k1 * std::log10(Z);
    double sum = c[count - 1];
    for (int i = count - 2; i >= 0; --i) sum = sum * u + c[i];
    return std::pow(10, sum);
  }
};

/// Valid from `nearest` to 40 m/kg^(1/3); durations from `shortest` on, and as there if nearer.
struct BlastCurves {
  double nearest, shortest;
  std::span<const BlastCurve> incident, reflected, incident_impulse, reflected_impulse, arrival, duration;
};
inline double blast_value(std::span<const BlastCurve> ranges, double Z) {
  for (const BlastCurve& range : ranges)
    if (Z <= range.up_to) return range.at(Z);
  return ranges.back().at(Z);
}
inline constexpr double farthest_blast = 40;

namespace free_air {
inline constexpr BlastCurve incident[] = {
    {40,
     -.214362789151,
     1.35034249993,
     9,
     {2.611368669, -1.69012801396, .00804973591951, .336743114941, -.00516226351334, -.0809228619888, -.00478507266747,
      .00793030472242, .0007684469735}}};
inline constexpr BlastCurve reflected[] = {
    {40,
     -.214362789151,
     1.35034249993,
     10,
     {3.22958031387, -2.21400538997, .035119031446, .657599992109, .0141818951887, -.243076636231, -.0158699803158,
      .0492741184234, .00227639644004, -.00397126276058}}};
inline constexpr BlastCurve incident_impulse[] = {
    {.792,
     2.34723921354,
     3.24299066475,
     5,
     {2.38830516757, -.443749377691, .168825414684, .0348138030308, -.010435192824}},
    {40,
     -1.75305660315,
     2.30629231803,
     9,
     {1.55197227115, -.40463292088, -.0142721946082, .00912366316617, -.0006750681404, -.00800863718901,
      .00314819515931, .00152044783382, -.0007470265899}}};
inline constexpr BlastCurve reflected_impulse[] = {
    {40, -.204004553231, 1.37882996018, 4, {2.55875660396, -.903118886091, .101771877942, -.0242139751146}}};
inline constexpr BlastCurve arrival[] = {{40,
                                          -.253273111999,
                                          1.37407043777,
                                          8,
                                          {.0720707787637, 1.36456871214, -.0570035692784, -.182832224796,
                                           .0118851436014, .0432648687627, -.0007997367834, -.00436073555033}}};
inline constexpr BlastCurve duration[] = {
    {.888,
     2.26367268496,
     5.11588554305,
     9,
     {-.686608550419, .164953518069, .127788499497, .00291430135946, .00187957449227, .0173413962543, .00269739758043,
      -.00361976502798, -.00100926577934}},
    {2.28,
     -1.33361206714,
     9.2996288611,
     9,
     {.23031841078, -.0297944268969, .0306329542941, .0183405574074, -.0173964666286, -.00106321963576, .0056206003128,
      .0001618217499, -.0006860188944}},
    {40,
     -3.13005805346,
     3.1524725364,
     8,
     {.621036276475, .0967031995552, -.00801302059667, .00482705779732, .00187587272287, -.00246738509321,
      -.000841116668, .0006193291052}}};
inline constexpr BlastCurves curves{.0531,   .147,    incident, reflected, incident_impulse, reflected_impulse,
                                    arrival, duration};
}  // namespace free_air

namespace hemisphere {
inline constexpr BlastCurve incident[] = {
    {40,
     -.214362789151,
     1.35034249993,
     12,
     {2.78076916577, -1.6958988741, -.154159376846, .514060730593, .0988534365274, -.293912623038, -.0268112345019,
      .109097496421, .00162846756311, -.0214631030242, .0001456723382, .00167847752266}}};
inline constexpr BlastCurve reflected[] = {
    {40,
     -.240657322658,
     1.36637719229,
     12,
     {3.40283217581, -2.21030870597, -.218536586295, .895319589372, .24989009775, -.569249436807, -.11791682383,
      .224131161411, .0245620259375, -.0455116002694, -.00190930738887, .00361471193389}}};
inline constexpr BlastCurve incident_impulse[] = {
    {.955,
     2.06761908721,
     3.0760329666,
     5,
     {2.52455620925, -.502992763686, .171335645235, .0450176963051, -.0118964626402}},
    {40,
     -1.94708846747,
     2.40697745406,
     8,
     {1.67281645863, -.384519026965, -.0260816706301, .00595798753822, .0145445261077, -.00663289334734,
      -.00284189327204, .0013644816227}}};
inline constexpr BlastCurve reflected_impulse[] = {
    {40, -.246208804814, 1.33422049854, 4, {2.70588058103, -.949516092853, .112136118689, -.0250659183287}}};
inline constexpr BlastCurve arrival[] = {
    {40,
     -.202425716178,
     1.37784223635,
     10,
     {-.0591634288046, 1.35706496258, .052492798645, -.196563954086, -.0601770052288, .0696360270891, .0215297490092,
      -.0161658930785, -.00232531970294, .00147752067524}}};
inline constexpr BlastCurve duration[] = {
    {1.01,
     1.92946154068,
     5.25099193925,
     6,
     {-.614227603559, .130143717675, .134872511954, .0391574276906, -.00475933664702, -.00428144598008}},
    {2.78,
     -2.12492525216,
     9.2996288611,
     9,
     {.315409245784, -.0297944268976, .030632954288, .0183405574086, -.0173964666211, -.00106321963633, .00562060030977,
      .0001618217499, -.0006860188944}},
    {40,
     -3.53626218091,
     3.46349745571,
     6,
     {.686906642409, .0933035304009, -.0005849420883, -.00226884995013, -.00295908591505, .00148029868929}}};
inline constexpr BlastCurves curves{.0674,   .178,    incident, reflected, incident_impulse, reflected_impulse,
                                    arrival, duration};
}  // namespace hemisphere

/// Decay b of p = P (1 - t/T) exp(-b t/T) whose impulse is `impulse` = P T (1/b - (1 - exp(-b))/b^2); 0 if that is more
/// than the triangle's P T/2.
inline double blast_decay(double impulse, double peak, double duration) {
  const double share = impulse / (peak * duration);
  const auto of = [](double b) { return b < 1e-4 ? 0.5 - b / 6 : (1 - (1 - std::exp(-b)) / b) / b; };
  if (share >= 0.5) return 0;
  double low = 0, high = 1;
  while (of(high) > share) high *= 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (of(middle) > share ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// The wave at a place [Pa, s].
struct BlastWave {
  double incident = 0, reflected = 0, arrival = 0, duration = 0, incident_decay = 0, reflected_decay = 0;

  /// distance [m], charge [kg of TNT]; the distance is taken as within the curves' range.
  static BlastWave at(const BlastCurves& curves, double distance, double charge) {
    const double root = std::cbrt(charge), Z = std::fmin(std::fmax(distance / root, curves.nearest), farthest_blast);
    BlastWave w;
    w.incident = 1e3 * blast_value(curves.incident, Z), w.reflected = 1e3 * blast_value(curves.reflected, Z);
    w.arrival = 1e-3 * root * blast_value(curves.arrival, Z);
    w.duration = 1e-3 * root * blast_value(curves.duration, std::fmax(Z, curves.shortest));
    w.incident_decay = blast_decay(root * blast_value(curves.incident_impulse, Z), w.incident, w.duration);
    w.reflected_decay = blast_decay(root * blast_value(curves.reflected_impulse, Z), w.reflected, w.duration);
    return w;
  }
  /// Overpressure on a face that sees the charge at the angle whose cosine is given (1: head on; <= 0: it looks away)
  /// [G. Randers-Pehrson, K. Bannister, Airblast loading model for DYNA2D and DYNA3D, ARL-TR-1310, 1997].
  double pressure(double cosine, double t) const {
    const double s = (t - arrival) / duration;
    if (s < 0 || s >= 1) return 0;
    const double side_on = incident * (1 - s) * std::exp(-incident_decay * s);
    if (cosine <= 0) return side_on;
    const double head_on = reflected * (1 - s) * std::exp(-reflected_decay * s);
    return side_on * (1 + cosine - 2 * cosine * cosine) + head_on * cosine * cosine;
  }
};

}  // namespace bw::csd
