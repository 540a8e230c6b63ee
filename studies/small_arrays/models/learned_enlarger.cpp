// SPDX-License-Identifier: Apache-2.0
#include "small_arrays/models/learned_enlarger.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <functional>
#include <system_error>
#include <utility>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

constexpr std::size_t kTaps = 9;
constexpr int kMostChannels = 1024;

std::size_t size(int count) { return static_cast<std::size_t>(count); }

/// The words of a text that are no comments, one after the other.
class WeightsReader {
 public:
  WeightsReader(std::string_view text, std::string_view name) : name_(name) {
    constexpr std::string_view kBlank = " \t\r";
    for (int line = 1; !text.empty(); ++line) {
      std::string_view rest = text.substr(0, text.find('\n'));
      text.remove_prefix(std::min(text.size(), rest.size() + 1));
      if (rest.starts_with('#')) {
        continue;
      }
      while (!(rest = rest.substr(std::min(rest.size(), rest.find_first_not_of(kBlank)))).empty()) {
        words_.push_back({rest.substr(0, rest.find_first_of(kBlank)), line});
        rest.remove_prefix(words_.back().text.size());
      }
    }
  }

  void expect(std::string_view word) {
    if (const std::string_view found = next(word); found != word) {
      fail(fmt::format("expected '{}', found '{}'", word, found));
    }
  }
  template <typename T>
  T number(const char* what) {
    const std::string_view text = next(what);
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() ||
        !std::isfinite(static_cast<double>(value))) {
      fail(fmt::format("{} is '{}', which is no number that can be used", what, text));
    }
    return value;
  }
  [[nodiscard]] bool at_end() const { return read_ == words_.size(); }

  /// Where: the line of the word read last.
  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError(fmt::format("{}, line {}: {}", name_, read_ == 0 ? 1 : words_[read_ - 1].line, reason));
  }

 private:
  struct Word {
    std::string_view text;
    int line;
  };
  std::string_view next(std::string_view what) {
    if (at_end()) {
      fail(fmt::format("the file ends, {} is missing", what));
    }
    return words_[read_++].text;
  }

  std::string_view name_;
  std::vector<Word> words_;
  std::size_t read_ = 0;
};

/// A map with a border of zeros, channel by channel.
class Bordered {
 public:
  Bordered(std::size_t columns, std::size_t rows) : columns_(columns), plane_((columns + 2) * (rows + 2)) {}

  void set(const float* map, std::size_t channels, std::size_t rows) {
    values_.assign(channels * plane_, 0.0F);
    for (std::size_t c = 0; c < channels; ++c) {
      for (std::size_t row = 0; row < rows; ++row) {
        std::copy_n(
            map + (c * rows + row) * columns_, columns_,
            values_.begin() + static_cast<std::ptrdiff_t>(c * plane_ + (row + 1) * (columns_ + 2) + 1));
      }
    }
  }
  /// The row that tap row `down` (0 .. 2) of an output's row reads.
  [[nodiscard]] const float* row(std::size_t channel, std::size_t row, std::size_t down) const {
    return &values_[channel * plane_ + (row + down) * (columns_ + 2)];
  }

 private:
  std::size_t columns_;
  std::size_t plane_;
  std::vector<float> values_;
};

std::vector<float> convolve(const Convolution& layer, const Bordered& input, std::size_t columns,
                            std::size_t rows) {
  std::vector<float> output(size(layer.outputs) * rows * columns);
  for (std::size_t o = 0; o < size(layer.outputs); ++o) {
    for (std::size_t row = 0; row < rows; ++row) {
      float* const out = &output[(o * rows + row) * columns];
      std::fill_n(out, columns, layer.biases[o]);
      for (std::size_t i = 0; i < size(layer.inputs); ++i) {
        const float* const taps = &layer.weights[(o * size(layer.inputs) + i) * kTaps];
        for (std::size_t down = 0; down < 3; ++down) {
          const float* const in = input.row(i, row, down);
          for (std::size_t x = 0; x < columns; ++x) {
            out[x] +=
                taps[3 * down] * in[x] + taps[3 * down + 1] * in[x + 1] + taps[3 * down + 2] * in[x + 2];
          }
        }
      }
    }
  }
  return output;
}

}  // namespace

EnlargerWeights parse_enlarger_weights(std::string_view text, std::string_view name) {
  WeightsReader reader(text, name);
  reader.expect("dtof-enlarger");
  if (const int version = reader.number<int>("the version"); version != 1) {
    reader.fail(fmt::format("version {} is not 1", version));
  }
  EnlargerWeights weights;
  reader.expect("joint_bilateral");
  for (double* const width : {&weights.joint_bilateral.spatial, &weights.joint_bilateral.range}) {
    *width = reader.number<double>("a width of the joint bilateral filter");
    if (!(*width > 0.0)) {
      reader.fail(fmt::format("a width of the joint bilateral filter is {:g}, not above 0", *width));
    }
  }
  int inputs = kFeatures;
  while (!reader.at_end()) {
    reader.expect("convolution");
    Convolution layer;
    layer.inputs = reader.number<int>("a layer's number of inputs");
    layer.outputs = reader.number<int>("a layer's number of outputs");
    if (layer.inputs != inputs || layer.outputs < 1 || layer.outputs > kMostChannels) {
      reader.fail(fmt::format("a layer of {} inputs and {} outputs cannot follow {} channels", layer.inputs,
                              layer.outputs, inputs));
    }
    for (int i = 0; i < layer.outputs; ++i) {
      layer.biases.push_back(reader.number<float>("a bias"));
    }
    for (std::size_t i = 0; i < size(layer.outputs) * size(layer.inputs) * kTaps; ++i) {
      layer.weights.push_back(reader.number<float>("a weight"));
    }
    inputs = layer.outputs;
    weights.layers.push_back(std::move(layer));
  }
  if (weights.layers.empty() || inputs != kCandidates) {
    reader.fail(weights.layers.empty()
                    ? "there is no layer"
                    : fmt::format("the last layer has {} outputs, not {}", inputs, kCandidates));
  }
  return weights;
}

EnlargerWeights trained_weights() {
  return parse_enlarger_weights(trained_weights_text(), "enlarge/weights.txt");
}

std::string write_enlarger_weights(const EnlargerWeights& weights, std::string_view comment) {
  std::string text;
  for (std::string_view rest = comment; !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    text += fmt::format("# {}\n", line);
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
  }
  text += fmt::format("dtof-enlarger 1\njoint_bilateral {:g} {:g}\n", weights.joint_bilateral.spatial,
                      weights.joint_bilateral.range);
  for (const Convolution& layer : weights.layers) {
    text += fmt::format("convolution {} {}\n", layer.inputs, layer.outputs);
    for (const std::vector<float>* values : {&layer.biases, &layer.weights}) {
      for (std::size_t i = 0; i < values->size(); ++i) {
        const bool line_ends = (i + 1) % kTaps == 0 || i + 1 == values->size();
        text += fmt::format("{:.5g}{}", (*values)[i], line_ends ? '\n' : ' ');
      }
    }
  }
  return text;
}

std::vector<float> enlarger_scores(const EnlargerWeights& weights, const EnlargerInput& input) {
  const std::size_t columns = size(input.columns);
  const std::size_t rows = size(input.rows);
  Bordered bordered(columns, rows);
  std::vector<float> values = input.features;
  for (const Convolution& layer : weights.layers) {
    if (&layer != &weights.layers.front()) {
      for (float& value : values) {
        value = std::max(0.0F, value);
      }
    }
    bordered.set(values.data(), size(layer.inputs), rows);
    values = convolve(layer, bordered, columns, rows);
  }
  std::ranges::transform(values, input.prior, values.begin(), std::plus<>());
  return values;
}

std::vector<double> mix_candidates(const EnlargerInput& input, const std::vector<float>& scores) {
  const std::size_t pixels = input.pixels();
  std::vector<double> distances;
  distances.reserve(pixels);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    double highest = scores[pixel];
    for (std::size_t k = 1; k < kCandidates; ++k) {
      highest = std::max(highest, double{scores[k * pixels + pixel]});
    }
    double weights = 0.0;
    double weighted = 0.0;
    for (std::size_t k = 0; k < kCandidates; ++k) {
      const double weight = std::exp(scores[k * pixels + pixel] - highest);
      weights += weight;
      weighted += weight * input.candidates[k * pixels + pixel];
    }
    distances.push_back(weighted / weights);
  }
  return distances;
}

std::vector<double> enlarge_learned(const SmallMap& map, const IntensityImage& image,
                                    const EnlargerWeights& weights) {
  const EnlargerInput input = make_enlarger_input(map, image);
  return mix_candidates(input, enlarger_scores(weights, input));
}

}  // namespace dtof
