// SPDX-License-Identifier: Apache-2.0
// train-enlarger: draws training maps, lets small arrays measure them, trains the learned enlarger's network
// on them with dlib, chooses the joint bilateral filter's widths on other training maps, and writes both as
// enlarge/weights.txt.
#include <dlib/dnn.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iterator>
#include <limits>
#include <numbers>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/core/random.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/sensor/preset.hpp"
#include "small_arrays/models/enlarger_input.hpp"
#include "small_arrays/models/intensity_image.hpp"
#include "small_arrays/models/learned_enlarger.hpp"
#include "small_arrays/small_array.hpp"
#include "small_arrays/trainer/mixing_loss.hpp"
#include "small_arrays/trainer/training_scene.hpp"

namespace dtof {
namespace {

constexpr int kColumns = 200;
constexpr int kRows = 160;
constexpr std::array<std::array<int, 2>, 3> kArrays = {{{100, 80}, {80, 64}, {50, 40}}};
constexpr std::array kLights = {4.0, 14.0, 30.0, 50.0, 80.0};
constexpr std::size_t kCut = 40;    // columns and rows of a cut-out
constexpr std::size_t kBorder = 3;  // pixels: as far as the network sees
constexpr long kChannels = 16;

struct Settings {
  int scenes = 12;
  int cuts = 8;
  int epochs = 4;
  int batch = 8;
  double rate = 0.003;
  std::uint64_t seed = 20261123;
  int threads = 1;
  std::string out = "build/weights.txt";
};

/// dlib's loss layer around mixing_loss.
class MixingLossLayer {
 public:
  // NOLINTBEGIN(readability-identifier-naming): names that dlib asks for
  using training_label_type = MixingTruth;
  using output_label_type = std::vector<float>;
  // NOLINTEND(readability-identifier-naming)

  template <typename Subnet, typename Labels>
  void to_label(const dlib::tensor& /*input*/, const Subnet& sub, Labels label) const {
    const dlib::tensor& output = sub.get_output();
    const auto size = static_cast<std::size_t>(output.k() * output.nr() * output.nc());
    for (std::size_t i = 0; i < static_cast<std::size_t>(output.num_samples()); ++i, ++label) {
      const float* const begin = output.host() + i * size;
      label->assign(begin, begin + size);
    }
  }

  template <typename Truths, typename Subnet>
  double compute_loss_value_and_gradient(const dlib::tensor& /*input*/, Truths truth, Subnet& sub) const {
    const dlib::tensor& output = sub.get_output();
    dlib::tensor& gradient = sub.get_gradient_input();
    const auto size = static_cast<std::size_t>(output.k() * output.nr() * output.nc());
    const auto samples = static_cast<std::size_t>(output.num_samples());
    double loss = 0.0;
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < samples; ++i, ++truth) {
      loss += mixing_loss({output.host() + i * size, size}, *truth, {gradient.host() + i * size, size});
      pixels += judged_pixels(*truth);
    }
    const auto scale = 1.0F / static_cast<float>(std::max<std::size_t>(pixels, 1));
    std::for_each_n(gradient.host(), samples * size, [&](float& value) { value *= scale; });
    return loss * static_cast<double>(scale);
  }

  friend void serialize(const MixingLossLayer& /*layer*/, std::ostream& out) {
    dlib::serialize("MixingLossLayer", out);
  }
  friend void deserialize(MixingLossLayer& /*layer*/, std::istream& in) {
    std::string name;
    dlib::deserialize(name, in);
  }
  friend std::ostream& operator<<(std::ostream& out, const MixingLossLayer& /*layer*/) {
    return out << "mixing_loss";
  }
  friend void to_xml(const MixingLossLayer& /*layer*/, std::ostream& out) { out << "<mixing_loss/>"; }
};

template <typename Subnet>
using Loss = dlib::add_loss_layer<MixingLossLayer, Subnet>;
template <long kOutputs, typename Subnet>
using Conv3x3 = dlib::con<kOutputs, 3, 3, 1, 1, Subnet>;
using Features = std::array<dlib::matrix<float>, kFeatures>;
using Network =
    Loss<Conv3x3<kCandidates,
                 dlib::relu<Conv3x3<kChannels, dlib::relu<Conv3x3<kChannels, dlib::input<Features>>>>>>>;

/// A map as a small array measured it.
struct Example {
  SmallMap map;
  IntensityImage image;
  std::vector<float> truth_m;
};

/// A small array at a light.
struct LitArray {
  SmallArray array;
  double klux;
};

std::vector<LitArray> make_arrays(const Settings& settings) {
  const std::vector<std::string> readouts = {"hispointer", "histogram32", "poolpointer"};
  const SensorModel sensor = find_sensor("thesis");
  std::vector<LitArray> arrays;
  Progress progress("look-up tables", kArrays.size() * kLights.size());
  for (const auto& [columns, rows] : kArrays) {
    const SpotGrid grid = make_spot_grid(kColumns, kRows, columns, rows);
    for (const double klux : kLights) {
      arrays.push_back({SmallArray(sensor, grid, klux, readouts, settings.seed, settings.threads), klux});
      progress.advance();
    }
  }
  return arrays;
}

/// `scenes` maps for every array, each measured by every read-out. Maps count on from `first`.
std::vector<Example> measure_examples(const std::vector<LitArray>& arrays, const Settings& settings,
                                      int scenes, std::uint32_t first) {
  const SensorModel sensor = find_sensor("thesis");
  std::vector<Example> examples;
  std::uint32_t number = first;
  Progress progress("maps", arrays.size() * static_cast<std::size_t>(scenes));
  for (const LitArray& lit : arrays) {
    for (int scene = 0; scene < scenes; ++scene, ++number) {
      const TargetMap targets = make_training_scene(kColumns, kRows, settings.seed, number);
      const std::uint64_t seed = settings.seed + number;  // no two maps share their photons
      const IntensityImage image = draw_intensity_image(sensor, targets, lit.klux, seed);
      std::vector<float> truth;
      for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column) {
          truth.push_back(static_cast<float>(targets.at(column, row).depth_m));
        }
      }
      for (SmallMap& map : lit.array.measure(targets, seed)) {
        examples.push_back({std::move(map), image, truth});
      }
      progress.advance();
    }
  }
  return examples;
}

struct Cut {
  Features features;
  MixingTruth truth;
};

/// Whether the network sees as much around a pixel of a cut-out as it would in the whole map, along one axis.
/// Beyond the map's own border it sees zeros in both.
bool sees_all(std::size_t begin, std::size_t i, std::size_t map_size) {
  const bool low = i >= kBorder || begin == 0;
  const bool high = i + kBorder < kCut || begin + kCut == map_size;
  return low && high;
}

Cut cut_out(const EnlargerInput& input, const std::vector<float>& truth, std::size_t left, std::size_t top) {
  Cut cut;
  const std::size_t pixels = input.pixels();
  const auto width = static_cast<std::size_t>(input.columns);
  for (std::size_t f = 0; f < kFeatures; ++f) {
    cut.features.at(f).set_size(kCut, kCut);
  }
  for (std::size_t y = 0; y < kCut; ++y) {
    for (std::size_t x = 0; x < kCut; ++x) {
      const std::size_t pixel = (top + y) * width + left + x;
      for (std::size_t f = 0; f < kFeatures; ++f) {
        cut.features.at(f)(static_cast<long>(y), static_cast<long>(x)) = input.features[f * pixels + pixel];
      }
      const bool judged = sees_all(left, x, kColumns) && sees_all(top, y, kRows);
      cut.truth.distance_m.push_back(judged ? truth[pixel] : 0.0F);
    }
  }
  for (std::size_t k = 0; k < kCandidates; ++k) {
    for (std::size_t y = 0; y < kCut; ++y) {
      const auto begin = static_cast<std::ptrdiff_t>(k * pixels + (top + y) * width + left);
      std::copy_n(input.candidates.begin() + begin, kCut, std::back_inserter(cut.truth.candidates));
      std::copy_n(input.prior.begin() + begin, kCut, std::back_inserter(cut.truth.prior));
    }
  }
  return cut;
}

std::size_t draw_below(CounterRandom& random, std::size_t count) {
  return std::min(count - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(count)));
}

std::vector<Cut> make_cuts(const std::vector<Example>& examples, const Settings& settings) {
  std::vector<Cut> cuts;
  CounterRandom random(settings.seed, static_cast<std::uint32_t>(RandomPurpose::kTrainingScene), 0xFFFFFFFF,
                       1);
  for (const Example& example : examples) {
    const EnlargerInput input = make_enlarger_input(example.map, example.image);
    for (int i = 0; i < settings.cuts; ++i) {
      const std::size_t left = draw_below(random, kColumns - kCut + 1);
      const std::size_t top = draw_below(random, kRows - kCut + 1);
      cuts.push_back(cut_out(input, example.truth_m, left, top));
    }
  }
  return cuts;
}

void train(Network& network, const std::vector<Cut>& cuts, const Settings& settings) {
  std::vector<std::size_t> order(cuts.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = i;
  }
  CounterRandom random(settings.seed, static_cast<std::uint32_t>(RandomPurpose::kTrainingScene), 0xFFFFFFFF,
                       2);
  const auto batch = static_cast<std::size_t>(settings.batch);
  const std::size_t steps = cuts.size() / batch;
  const auto all_steps = static_cast<double>(steps) * settings.epochs;
  std::vector<dlib::adam> solvers(Network::num_computational_layers, dlib::adam(0.0F, 0.9F, 0.999F));
  Progress progress("training", steps * static_cast<std::size_t>(settings.epochs));
  for (int epoch = 0; epoch < settings.epochs; ++epoch) {
    for (std::size_t i = order.size(); i-- > 1;) {
      std::swap(order[i], order[draw_below(random, i + 1)]);
    }
    double loss = 0.0;
    for (std::size_t step = 0; step < steps; ++step) {
      check_interruption();
      std::vector<Features> features;
      std::vector<MixingTruth> truths;
      for (std::size_t i = 0; i < batch; ++i) {
        const Cut& cut = cuts[order[step * batch + i]];
        features.push_back(cut.features);
        truths.push_back(cut.truth);
      }
      loss += network.compute_parameter_gradients(features.begin(), features.end(), truths.begin());
      const double done = (epoch * static_cast<double>(steps) + static_cast<double>(step)) / all_steps;
      network.update_parameters(dlib::make_sstack(solvers),
                                settings.rate * 0.5 * (1.0 + std::cos(std::numbers::pi * done)));
      progress.advance();
    }
    fmt::print("epoch {}: mean loss {:.5f}\n", epoch + 1, loss / static_cast<double>(steps));
    std::fflush(stdout);
  }
}

template <std::size_t kLayer>
Convolution& copy_layer(Network& network, EnlargerWeights& weights, int inputs, int outputs) {
  const dlib::tensor& values = dlib::layer<kLayer>(network).layer_details().get_layer_params();
  Convolution& layer = weights.layers.emplace_back();
  layer.inputs = inputs;
  layer.outputs = outputs;
  const auto count = static_cast<std::ptrdiff_t>(inputs) * outputs * 9;
  layer.weights.assign(values.host(), values.host() + count);
  layer.biases.assign(values.host() + count, values.host() + values.size());
  return layer;
}

/// Layers of dlib are numbered from the loss.
EnlargerWeights weights_of(Network& network) {
  EnlargerWeights weights;
  copy_layer<5>(network, weights, kFeatures, kChannels);
  copy_layer<3>(network, weights, kChannels, kChannels);
  copy_layer<1>(network, weights, kChannels, kCandidates);
  return weights;
}

template <std::size_t kLayer>
void put_layer(Network& network, const Convolution& layer) {
  dlib::tensor& values = dlib::layer<kLayer>(network).layer_details().get_layer_params();
  std::ranges::copy(layer.weights, values.host());
  std::ranges::copy(layer.biases, values.host() + layer.weights.size());
}

void put_weights(Network& network, const EnlargerWeights& weights) {
  put_layer<5>(network, weights.layers.at(0));
  put_layer<3>(network, weights.layers.at(1));
  put_layer<1>(network, weights.layers.at(2));
}

/// Largest difference between dlib's scores of a whole map and those of the plain inference.
double largest_difference(Network& network, const EnlargerWeights& weights, const Example& example) {
  const EnlargerInput input = make_enlarger_input(example.map, example.image);
  Features features;
  for (std::size_t f = 0; f < kFeatures; ++f) {
    features.at(f).set_size(kRows, kColumns);
    std::copy_n(input.features.begin() + static_cast<std::ptrdiff_t>(f * input.pixels()), input.pixels(),
                features.at(f).begin());
  }
  const std::vector<float> theirs = network(features);
  const std::vector<float> ours = enlarger_scores(weights, input);
  double largest = 0.0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    largest = std::max(largest, std::abs(double{ours[i]} - input.prior[i] - theirs.at(i)));
  }
  return largest;
}

double mean_loss(const Example& example, const std::vector<double>& distances) {
  double loss = 0.0;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    loss += distance_loss(distances[i], example.truth_m[i]);
  }
  return loss / static_cast<double>(distances.size());
}

/// Mean loss over all examples.
template <typename Enlarge>
double mean_loss(const std::vector<Example>& examples, Enlarge enlarge) {
  double loss = 0.0;
  for (const Example& example : examples) {
    check_interruption();
    loss += mean_loss(example, enlarge(example)) / static_cast<double>(examples.size());
  }
  return loss;
}

JointBilateral choose_joint_bilateral(const std::vector<Example>& examples) {
  JointBilateral best;
  double least = std::numeric_limits<double>::infinity();
  for (const double spatial : {0.1, 0.15, 0.2, 0.25, 0.35}) {
    for (const double range : {0.02, 0.03, 0.045, 0.06, 0.09}) {
      const JointBilateral widths{spatial, range};
      const double loss = mean_loss(
          examples, [&](const Example& e) { return enlarge_joint_bilateral(e.map, e.image, widths); });
      fmt::print("joint bilateral, widths {:g} and {:g}: mean loss {:.5f}\n", spatial, range, loss);
      if (loss < least) {
        least = loss;
        best = widths;
      }
    }
  }
  return best;
}

void run(const Settings& settings, const std::string& command_line) {
  constexpr std::uint32_t kChoosing = 100'000;  // numbers of the maps that the widths are chosen on
  constexpr double kTolerance = 1e-3;
  const std::vector<LitArray> arrays = make_arrays(settings);
  const std::vector<Example> examples = measure_examples(arrays, settings, settings.scenes, 0);
  const std::vector<Cut> cuts = make_cuts(examples, settings);
  fmt::print("{} maps, {} cut-outs of {} x {} pixels, seed {}\n", examples.size(), cuts.size(), kCut, kCut,
             settings.seed);
  std::srand(static_cast<unsigned>(settings.seed));  // dlib draws the first weights from rand()
  Network network;
  train(network, cuts, settings);

  const std::vector<Example> others = measure_examples(arrays, settings, 1, kChoosing);
  EnlargerWeights weights = weights_of(network);
  weights.joint_bilateral = choose_joint_bilateral(others);
  const std::string text =
      write_enlarger_weights(weights, "SPDX-License-Identifier: Apache-2.0\n" + command_line);
  weights = parse_enlarger_weights(text, settings.out);  // with the digits that are written
  put_weights(network, weights);
  double difference = 0.0;
  for (const std::size_t i : {std::size_t{0}, others.size() / 2, others.size() - 1}) {
    difference = std::max(difference, largest_difference(network, weights, others[i]));
  }
  fmt::print("dlib's scores and the plain inference's differ by at most {:.2g}\n", difference);
  if (!(difference <= kTolerance)) {
    throw InputError(fmt::format("they must differ by at most {:g}: nothing is written", kTolerance));
  }
  fmt::print("mean loss on maps not trained on: nearest {:.5f}, bilinear {:.5f}, learned {:.5f}\n",
             mean_loss(others, [](const Example& e) { return enlarge_nearest(e.map); }),
             mean_loss(others, [](const Example& e) { return enlarge_bilinear(e.map); }),
             mean_loss(others, [&](const Example& e) { return enlarge_learned(e.map, e.image, weights); }));
  write_file(settings.out, text);
  fmt::print("{} written\n", settings.out);
}

}  // namespace
}  // namespace dtof

int main(int argc, char** argv) {
  dtof::Settings settings;
  CLI::App app("Trains the learned enlarger and chooses the joint bilateral filter's widths");
  app.add_option("--scenes", settings.scenes, "maps of each array and light")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--cuts", settings.cuts, "cut-outs of each map and read-out")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--epochs", settings.epochs, "passes over the cut-outs")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--batch", settings.batch, "cut-outs of a step")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--rate", settings.rate, "first step size; it falls to 0 as a cosine")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("-s,--seed", settings.seed, "seed of maps, photons, first weights and order")
      ->capture_default_str();
  app.add_option("-j,--threads", settings.threads, "threads that draw photons, 0 = all processors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("-o,--out", settings.out, "file to write")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    dtof::install_interruption_handler();
    dtof::run(settings,
              fmt::format("train-enlarger --scenes {} --cuts {} --epochs {} --batch {} --rate {:g} --seed {}",
                          settings.scenes, settings.cuts, settings.epochs, settings.batch, settings.rate,
                          settings.seed));
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 1;
  }
  return 0;
}
