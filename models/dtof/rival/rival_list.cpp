// SPDX-License-Identifier: Apache-2.0
// The one list of rivals: tables, options and tests take them from here, in this order.
#include <array>

#include "dtof/rival/cfar_detector.hpp"
#include "dtof/rival/coarse_histogram.hpp"
#include "dtof/rival/equi_depth.hpp"
#include "dtof/rival/equi_depth_fit.hpp"
#include "dtof/rival/guided_window.hpp"
#include "dtof/rival/legendre_memory.hpp"
#include "dtof/rival/linear_code.hpp"
#include "dtof/rival/linearised_average.hpp"
#include "dtof/rival/online_em.hpp"
#include "dtof/rival/optimised_code.hpp"
#include "dtof/rival/rival.hpp"

namespace dtof {

// A rival whose file has no header is declared here.

namespace {

using Made = std::unique_ptr<Rival>;
using Sensor = SensorModel;

constexpr std::string_view kWholeFrame =
    "histograms in the pixel: Hutchings, JSSC 2019; Edinburgh and Ouster, IISW 2025 (16 bins of 18 bits)";
constexpr std::string_view kEquiDepth = "Ingle and Maier, TPAMI 2023 (arXiv 2307.04924)";
constexpr std::string_view kProportional = "Sadekar et al., ECCV 2024 (arXiv 2408.16150)";
constexpr std::string_view kCompressive = "Gutierrez-Barragan et al., CVPR 2022";
constexpr std::string_view kCorrelations = "Kuijk, Sensors 2025, 25(21) 6772";
constexpr std::string_view kOnlineEm =
    "Poisson, Guicquero, Coriat and Sicard, a 2-stage EM algorithm for online peak detection (CEA-Leti)";
constexpr std::string_view kSketch = "Sheehan, Tachella and Davies, arXiv 2102.08732";
constexpr std::string_view kSpline = "arXiv 2210.07314";
constexpr std::string_view kSpiking =
    "Legendre memory unit (Voelker, Kajic and Eliasmith, NeurIPS 2019) with a matched filter: an upper bound "
    "of the spiking network of MacLean, Stewart and Gyongy (arXiv 2401.10793) with a unit of this order";
constexpr std::string_view kLinearised =
    "Tontini et al., IEEE Sensors Journal 24(4), 2024 (arXiv 2310.09176)";
constexpr std::string_view kAsynchronous = "Liu et al., arXiv 2509.19192; ISCAS 2025";
constexpr std::string_view kOptimised =
    "an optimisation of this project, in place of the learned code of Feng et al., IEEE Sensors Journal 2025 "
    "(doi 10.1109/JSEN.2025.3575784), which is not public";
constexpr std::string_view kHighFlux =
    "Sadekar et al., High-Flux Count-Free Single-Photon 3D Cameras, ICCP 2025";

template <int kParts>
Made hierarchical(const Sensor& sensor) {
  return make_hierarchical_equi_depth(sensor, {.parts = kParts});
}
template <int kParts, bool kOptimised>
Made proportional(const Sensor& sensor) {
  return make_proportional_equi_depth(sensor, {.parts = kParts, .optimised = kOptimised});
}
template <int kCounters, int kBits>
Made truncated(const Sensor& sensor) {
  return make_fourier(sensor, truncated_fourier(kCounters), kBits);
}
template <int kCounters, int kBits>
Made gray(const Sensor& sensor) {
  return make_fourier(sensor, gray_fourier(kCounters, largest_harmonic(sensor)), kBits);
}
Made signs_of_two_harmonics(const Sensor& sensor) {
  constexpr std::array<CodeWave, 4> kWaves = {{{1, false}, {1, true}, {4, false}, {4, true}}};
  return make_fourier(sensor, kWaves, 1);
}
template <int kShift>
Made correlations(const Sensor& sensor) {
  return make_two_correlations(sensor, kShift);
}
template <int kSize>
Made sketch(const Sensor& sensor) {
  return make_sketch(sensor, kSize);
}
template <bool kEarly>
Made cfar(const Sensor& sensor) {
  return make_cfar_detector(sensor, {.early = kEarly});
}
template <int kParts>
Made fitted(const Sensor& sensor) {
  return make_fitted_equi_depth(sensor, kParts);
}
template <int kKnots, int kCountBits>
Made spline(const Sensor& sensor) {
  return make_spline_sketch(sensor, kKnots, kCountBits);
}

template <int kOrder>
Made legendre(const Sensor& sensor) {
  return make_legendre_memory(sensor, kOrder);
}

constexpr std::array kRivals = std::to_array<RivalEntry>({
    {"histogram32", "32-bin histogram", kWholeFrame,
     [](const Sensor& sensor) { return make_coarse_histogram(sensor, {}); },
     RivalClaim{{0.2, 0.0}, {3.2, 1.4}}},

    {"median", "equi-depth, one binner", kEquiDepth, hierarchical<2>},
    {"hedh4", "HEDH-4", kProportional, hierarchical<4>, RivalClaim{{25.0, 25.0}, {42.0, 37.0}}},
    {"hedh16", "HEDH-16", kProportional, hierarchical<16>},
    {"hedh16-fitted", "HEDH-16, fitted", kHighFlux, fitted<16>},
    {"pedh2", "PEDH-2", kProportional, proportional<2, false>, RivalClaim{{9.0, 0.0}, {26.0, 0.0}}},
    {"pedh4", "PEDH-4", kProportional, proportional<4, false>, RivalClaim{{48.0, 36.0}, {31.0, 18.0}}},
    {"pedh8", "PEDH-8", kProportional, proportional<8, false>, RivalClaim{{60.0, 44.0}, {48.0, 41.0}}},
    {"pedh8-optimised", "PEDH-8 optimised", kProportional, proportional<8, true>},
    {"pedh16-optimised", "PEDH-16 optimised", kProportional, proportional<16, true>},

    {"fourier4", "truncated Fourier K = 4", kCompressive, truncated<4, 4>,
     RivalClaim{{51.2, 4.6}, {62.8, 17.6}}},
    {"fourier8", "truncated Fourier K = 8", kCompressive, truncated<8, 4>},
    {"fourier16", "truncated Fourier K = 16", kCompressive, truncated<16, 4>,
     RivalClaim{{0.6, 0.0}, {5.8, 1.4}}},
    {"fourier16-3bit", "truncated Fourier K = 16, 3 bits", kCompressive, truncated<16, 3>},
    {"fourier16-2bit", "truncated Fourier K = 16, 2 bits", kCompressive, truncated<16, 2>},
    {"fourier16-1bit", "truncated Fourier K = 16, 1 bit", kCompressive, truncated<16, 1>},
    {"gray8", "Gray-Fourier K = 8", kCompressive, gray<8, 4>, RivalClaim{{6.2, 0.0}, {31.0, 14.0}}},
    {"gray8-3bit", "Gray-Fourier K = 8, 3 bits", kCompressive, gray<8, 3>},
    {"gray8-2bit", "Gray-Fourier K = 8, 2 bits", kCompressive, gray<8, 2>},
    {"gray8-1bit", "Gray-Fourier K = 8, 1 bit", kCompressive, gray<8, 1>},
    {"optimised8", "optimised harmonics K = 8", kOptimised,
     [](const Sensor& sensor) { return make_optimised_code(sensor, 8); }},
    {"signs", "sign-Fourier, harmonics 1 and 4", kCompressive, signs_of_two_harmonics,
     RivalClaim{{57.4, 22.6}, {86.8, 53.4}}},

    {"correlations", "two correlations, mean of 256", kCorrelations, correlations<8>},
    {"correlations-slow", "two correlations, mean of 4096", kCorrelations, correlations<12>,
     RivalClaim{{72.6, 24.8}, {87.4, 62.0}}},
    {"online-em", "online EM", kOnlineEm, make_online_em},
    {"guided", "guided window", "Edinburgh's guided dToF; FoveaSPAD, arXiv 2412.02052",
     [](const Sensor& sensor) { return make_guided_window(sensor, {}); }},

    {"sketch2", "sketch M = 2", kSketch, sketch<2>, RivalClaim{{51.2, 4.6}, {62.8, 17.6}}},
    {"sketch4", "sketch M = 4", kSketch, sketch<4>},
    {"spline4", "spline sketch m = 4", kSpline, spline<4, 12>, RivalClaim{{61.2, 18.2}, {74.6, 21.6}}},
    {"spline16", "spline sketch m = 16", kSpline, spline<16, 11>, RivalClaim{{1.6, 0.0}, {8.6, 2.6}}},

    {"legendre8", "Legendre memory d = 8", kSpiking, legendre<8>},
    {"legendre16", "Legendre memory d = 16", kSpiking, legendre<16>},

    {"linearised", "linearised average", kLinearised, make_linearised_average},
    {"cfar", "CFAR detector, first report", kAsynchronous, cfar<true>},
    {"cfar-frame", "CFAR detector, whole frame", kAsynchronous, cfar<false>},
});

}  // namespace

std::span<const RivalEntry> all_rivals() { return kRivals; }

}  // namespace dtof
