/* SPDX-License-Identifier: Apache-2.0 */
#include "dtof_filter.h"

#include <stddef.h>

#define REACH 2U /* of the window, in pixels to each side */
#define SIDE 5U
#define PIXELS 25U
#define CENTRE 12U
#define CANDIDATES 8U
#define MOST_SHIFT 31U

/* A frame and the lines that are needed after the filter has written over them. */
typedef struct {
  const dtof_filter_settings *settings;
  uint32_t columns;
  uint32_t rows;
  uint32_t *depths;
  const uint16_t *confidences; /* or null */
  uint32_t mean;               /* of the confidences */
  uint32_t *lines;             /* row r as it was lies in line r % DTOF_FILTER_LINES */
} frame;

/* The pixels around a pixel, row by row. A pixel that is invalid or outside the frame has the share 0. */
typedef struct {
  uint32_t depth[PIXELS];
  uint32_t share[PIXELS]; /* weight by confidence times nearness */
} window;

/* What the window holds of a surface. */
typedef struct {
  uint32_t support;
  uint32_t depth; /* weighted mean of the supporters */
} surface;

/* A near pixel counts more than a far one. */
static const uint8_t nearness[PIXELS] = {1, 1, 1, 1, 1, 1, 2, 2, 2, 1, 1, 2, 4,
                                         2, 1, 1, 2, 2, 2, 1, 1, 1, 1, 1, 1};
/* The eight neighbours, whose surfaces the pixel may take. Of equal support the first one wins. */
static const uint8_t candidates[CANDIDATES] = {7, 11, 13, 17, 6, 8, 16, 18};

static bool is_valid(uint32_t depth) { return depth <= DTOF_FILTER_MOST_DEPTH; }

dtof_filter_settings dtof_filter_defaults(uint32_t pulse) {
  dtof_filter_settings settings;
  settings.tolerance = pulse / 16U;
  settings.tolerance_shift = 5U;
  settings.rival_shift = 6U;
  settings.fill = 64U;
  return settings;
}

/* Mean of the valid pixels' confidences, rounded. */
static uint32_t mean_confidence(size_t pixels, const uint32_t *depths, const uint16_t *confidences) {
  uint64_t sum = 0;
  uint64_t count = 0;
  for (size_t i = 0; i < pixels; ++i) {
    if (is_valid(depths[i])) {
      sum += confidences[i];
      ++count;
    }
  }
  return count == 0U ? 0U : (uint32_t)((sum + count / 2U) / count);
}

/* Weight of a valid pixel. Without confidences, or if their mean is 0, all pixels have the same. */
static uint32_t weight_of(const frame *from, size_t pixel) {
  uint32_t weight = DTOF_FILTER_MEAN_WEIGHT;
  if (from->confidences != NULL && from->mean != 0U) {
    weight = DTOF_FILTER_MEAN_WEIGHT * from->confidences[pixel] / from->mean;
  }
  if (weight < 1U) {
    weight = 1U;
  }
  return weight < DTOF_FILTER_MOST_WEIGHT ? weight : DTOF_FILTER_MOST_WEIGHT;
}

/* Rows up to the present one come from the lines, those below are not yet filtered. */
static void gather(const frame *from, uint32_t row, uint32_t column, window *around) {
  for (uint32_t i = 0; i < PIXELS; ++i) {
    /* Both are REACH too large, so that they cannot be negative. */
    uint32_t y = row + i / SIDE;
    uint32_t x = column + i % SIDE;
    around->share[i] = 0U;
    around->depth[i] = DTOF_FILTER_INVALID;
    if (y >= REACH && y - REACH < from->rows && x >= REACH && x - REACH < from->columns) {
      y -= REACH;
      x -= REACH;
      size_t pixel = (size_t)y * from->columns + x;
      uint32_t depth =
          y > row ? from->depths[pixel] : from->lines[(size_t)(y % DTOF_FILTER_LINES) * from->columns + x];
      if (is_valid(depth)) {
        around->depth[i] = depth;
        around->share[i] = weight_of(from, pixel) * nearness[i];
      }
    }
  }
}

static surface surface_at(const dtof_filter_settings *settings, const window *around, uint32_t depth) {
  uint64_t tolerance = (uint64_t)settings->tolerance + (depth >> settings->tolerance_shift);
  uint64_t sum = 0;
  surface found = {0U, DTOF_FILTER_INVALID};
  for (uint32_t i = 0; i < PIXELS; ++i) {
    uint32_t other = around->depth[i];
    uint32_t difference = other > depth ? other - depth : depth - other;
    if (around->share[i] != 0U && difference <= tolerance) {
      found.support += around->share[i];
      sum += (uint64_t)around->share[i] * other;
    }
  }
  if (found.support != 0U) {
    found.depth = (uint32_t)((sum + found.support / 2U) / found.support);
  }
  return found;
}

/* The filtered depth of the window's middle. */
static uint32_t filtered(const dtof_filter_settings *settings, const window *around) {
  bool valid = around->share[CENTRE] != 0U;
  surface own = {0U, DTOF_FILTER_INVALID};
  surface best = own;
  if (valid) {
    own = surface_at(settings, around, around->depth[CENTRE]);
  }
  for (uint32_t i = 0; i < CANDIDATES; ++i) {
    uint32_t place = candidates[i];
    if (around->share[place] != 0U) {
      surface other = surface_at(settings, around, around->depth[place]);
      if (other.support > best.support) {
        best = other;
      }
    }
  }
  if (!valid) {
    return best.support >= settings->fill ? best.depth : DTOF_FILTER_INVALID;
  }
  return (best.support >> settings->rival_shift) >= own.support ? best.depth : own.depth;
}

bool dtof_filter(const dtof_filter_settings *settings, uint16_t columns, uint16_t rows, uint32_t *depths,
                 const uint16_t *confidences, uint32_t *lines) {
  size_t pixels = (size_t)rows * columns;
  frame whole = {settings, columns, rows, depths, confidences, 0U, lines};
  if (pixels == 0U || settings->tolerance_shift > MOST_SHIFT || settings->rival_shift > MOST_SHIFT) {
    return false;
  }
  if (confidences != NULL) {
    whole.mean = mean_confidence(pixels, depths, confidences);
  }
  for (uint32_t row = 0; row < rows; ++row) {
    uint32_t *line = &lines[(size_t)(row % DTOF_FILTER_LINES) * columns];
    uint32_t *written = &depths[(size_t)row * columns];
    for (uint32_t column = 0; column < columns; ++column) {
      line[column] = written[column];
    }
    for (uint32_t column = 0; column < columns; ++column) {
      window around;
      gather(&whole, row, column, &around);
      written[column] = filtered(settings, &around);
    }
  }
  return true;
}
