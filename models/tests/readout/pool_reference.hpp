// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/result.hpp"

namespace dtof {

/// Independent reference of poolPointer and poolPointer lean, as slow and as close to
/// docs/reference/poolpointer.md as possible: a dictionary from (column, row) to a pixel, plain numbers where
/// the model has named parameters, positions instead of cells, and every chain solved anew for every label of
/// every pixel.
class PoolReference {
 public:
  struct Place {
    int column;
    int row;
    bool operator<(const Place& other) const {
      return column != other.column ? column < other.column : row < other.row;
    }
  };

  struct Pixel {
    std::map<int, std::vector<int>> seen;  // acquisition: positions of the first one or two timestamps
    std::vector<int> score;
    int leader = 0;
    int offset = 0;
    int chosen = 0;
    bool sure = false;
    int alone = 0;  // where its leader's pointer would start without its neighbours
    int n = 0, pa = 0, pb = 0;
    int ka = 0, kb = 0;  // lean: whose candidates they are
    int winner = 0, loser = 0, margin = 0;
    int significance = 0;
  };

  struct Group {
    std::vector<int> h = std::vector<int>(32, 0);
    std::vector<int> cell;
    int b = 0;
    bool frozen = false;
    bool tilted = false;
    std::vector<int> significance;  // of each candidate
  };

  /// What the definition leaves open.
  struct Open {
    int coarse = 14;  // 64ths
    int track = 30;
    bool left_needs_margin = false;
    bool smooth = true;
    bool lean = false;  ///< the numbers of poolPointer lean
    bool second_target = false;
    bool amplitude = true;
    int cell = 512;               ///< positions of a settled pointer's cell
    bool prior = false;           ///< the array has PRIOR = 1
    std::array<int, 32> taken{};  ///< fours that a bin's sum loses
  };

  /// Chosen cells by group.
  using Used = std::map<Place, std::set<int>>;

  /// `columns`: those of one engine, from left to right. `before`: used() of the last frame.
  PoolReference(const std::vector<ColumnStream>& columns, int np, int acquisitions, Open open,
                Used before = {});

  std::vector<std::vector<PixelResult>> run();

  /// The cells that the pixels of each group chose. Call run() first.
  [[nodiscard]] Used used() const;

 private:
  [[nodiscard]] int coarse_end() const { return all_ * open_.coarse / 64; }
  [[nodiscard]] int track_end() const { return all_ * (open_.coarse + open_.track) / 64; }

  [[nodiscard]] int labels() const { return open_.lean ? 4 : 5; }
  [[nodiscard]] int group_rows() const { return open_.lean ? 8 : 4; }

  Group& group(Place place) { return groups_[{place.column / 2, place.row / group_rows()}]; }

  static int preferred(int a, const std::vector<int>& times);

  void coarse();

  static void sweep(Group& swept);

  void decode(Place place, Group& own);

  /// Logarithm to base 2 in eighths: 8 e + m, with e the index of the highest bit of x and m the next three
  /// bits.
  static int lg(int x);

  [[nodiscard]] int significance(const std::vector<int>& w, const std::vector<int>& earlier, int peak,
                                 int missing, int raise) const;

  /// True if a position counts for no label, because background comes early.
  static bool thinned(int a, int x);

  /// Distance from a position in whole cells, towards minus infinity.
  static int cells(int x, int from);

  template <typename Test>
  static int take(int a, const std::vector<int>& times, Test inside);

  /// The first candidate whose window has a position; -1 if none has.
  static int label_of(const Group& g, int x);
  static bool near_candidate(const Group& g, int k, int x);

  void track(Pixel& pixel, const Group& g, int a, const std::vector<int>& times) const;

  /// Evidence of a pixel's scores alone.
  std::vector<int> own_evidence(Place place);

  static std::pair<std::size_t, std::size_t> best_two(const std::vector<int>& values);

  /// By pixel and label, the best sum over all assignments of the other pixels, found by walking outwards
  /// from the pixel.
  static std::vector<std::vector<int>> beliefs(const std::vector<std::vector<int>>& evidence,
                                               const std::vector<std::vector<int>>& position,
                                               const std::vector<int>& lambda);

  /// Best sum of all pixels on one side of a pixel that has a label; they pay their own lambdas towards it.
  static int beyond(const std::vector<std::vector<int>>& evidence,
                    const std::vector<std::vector<int>>& position, const std::vector<int>& lambda, int pixel,
                    std::size_t label, int direction);
  static int best_step(const std::vector<int>& value, const std::vector<int>& from, int to, int lambda);

  void choose(int c);

  /// Pixels above, below and to the left with a position near that of `place`.
  template <typename Position>
  std::vector<Place> near_places(Place place, Position position);

  /// By how much a position moves towards those of the pixels above, below and to the left.
  template <typename Position>
  int towards_neighbours(Place place, Position position);

  /// Moves lean's pointer: the rival stays at its candidate, and the pointer leaves its own candidate by at
  /// most half a coarse bin.
  void point_lean(Pixel& pixel, const Group& g, int a, const std::vector<int>& times) const;

  void point(Pixel& pixel, int a, const std::vector<int>& times) const;

  void decide(int c);

  int confidence(Place place);

  /// How many counts an advantage stands for.
  [[nodiscard]] int counts(int n) const;

  PixelResult result(Place place);

  Used before_;
  int columns_;
  int rows_;
  int np_;
  int all_;
  Open open_;
  std::map<Place, Pixel> pixels_;
  std::map<Place, Group> groups_;
};

}  // namespace dtof
