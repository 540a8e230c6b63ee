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
  uint32_t columns;
  uint32_t rows;
  const uint32_t *depths;
  const uint32_t *lines; /* row r as it was lies in line r % DTOF_FILTER_LINES */
} frame;

/* The pixels around a pixel, row by row; DTOF_FILTER_INVALID outside the frame. */
typedef struct {
  uint32_t depth[PIXELS];
} window;

/* What the window holds of a surface. */
typedef struct {
  uint32_t support; /* pixels */
  uint32_t depth;   /* their mean */
} surface;

/* The eight neighbours, whose surfaces the pixel may take. Of equal support the first one wins. */
static const uint8_t candidates[CANDIDATES] = {7, 11, 13, 17, 6, 8, 16, 18};

static bool is_valid(uint32_t depth) { return depth <= DTOF_FILTER_MOST_DEPTH; }

dtof_filter_settings dtof_filter_defaults(uint32_t pulse) {
  dtof_filter_settings settings;
  settings.tolerance = pulse / 16U;
  settings.tolerance_shift = 5U;
  return settings;
}

/* Rows up to the present one come from the lines, those below are not yet filtered. */
static void gather(const frame *from, uint32_t row, uint32_t column, window *around) {
  for (uint32_t i = 0; i < PIXELS; ++i) {
    /* Both are REACH too large, so that they cannot be negative. */
    uint32_t y = row + i / SIDE;
    uint32_t x = column + i % SIDE;
    around->depth[i] = DTOF_FILTER_INVALID;
    if (y >= REACH && y - REACH < from->rows && x >= REACH && x - REACH < from->columns) {
      y -= REACH;
      x -= REACH;
      around->depth[i] = y > row ? from->depths[(size_t)y * from->columns + x]
                                 : from->lines[(size_t)(y % DTOF_FILTER_LINES) * from->columns + x];
    }
  }
}

/* The surface at a valid depth that a pixel of the window has. */
static surface surface_at(const dtof_filter_settings *settings, const window *around, uint32_t depth) {
  uint64_t tolerance = (uint64_t)settings->tolerance + (depth >> settings->tolerance_shift);
  uint64_t sum = 0;
  surface found = {0U, DTOF_FILTER_INVALID};
  for (uint32_t i = 0; i < PIXELS; ++i) {
    uint32_t other = around->depth[i];
    uint32_t difference = other > depth ? other - depth : depth - other;
    if (is_valid(other) && difference <= tolerance) {
      ++found.support;
      sum += other;
    }
  }
  found.depth = (uint32_t)((sum + found.support / 2U) / found.support);
  return found;
}

/* The surface of a neighbour that most pixels are on; support 0 without a valid neighbour. */
static surface best_around(const dtof_filter_settings *settings, const window *around) {
  surface best = {0U, DTOF_FILTER_INVALID};
  for (uint32_t i = 0; i < CANDIDATES; ++i) {
    uint32_t depth = around->depth[candidates[i]];
    if (is_valid(depth)) {
      surface other = surface_at(settings, around, depth);
      if (other.support > best.support) {
        best = other;
      }
    }
  }
  return best;
}

/* The filtered depth of the window's middle. */
static uint32_t filtered(const dtof_filter_settings *settings, const window *around) {
  uint32_t here = around->depth[CENTRE];
  uint32_t others = 0;
  surface best;
  if (is_valid(here)) {
    surface own = surface_at(settings, around, here);
    if (own.support > 1U) {
      return own.depth;
    }
  } else {
    here = DTOF_FILTER_INVALID;
  }
  for (uint32_t i = 0; i < PIXELS; ++i) {
    others += i != CENTRE && is_valid(around->depth[i]) ? 1U : 0U;
  }
  best = best_around(settings, around);
  return others >= DTOF_FILTER_LEAST_OTHERS && 3U * best.support >= 2U * others ? best.depth : here;
}

bool dtof_filter(const dtof_filter_settings *settings, uint16_t columns, uint16_t rows, uint32_t *depths,
                 uint32_t *lines) {
  frame whole = {columns, rows, depths, lines};
  if (columns == 0U || rows == 0U || settings->tolerance_shift > MOST_SHIFT) {
    return false;
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
