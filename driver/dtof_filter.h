/* SPDX-License-Identifier: Apache-2.0
 * Host filter of a finished depth frame (docs/reference/accuracy.md). C99, integers alone, without
 * dependencies and without memory of its own. The filter needs no device and works for every read-out.
 */
#ifndef DTOF_FILTER_H
#define DTOF_FILTER_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define DTOF_FILTER_INVALID UINT32_MAX /* a pixel without a depth */
#define DTOF_FILTER_MOST_DEPTH UINT32_C(0x7FFFFFFF)
#define DTOF_FILTER_LINES 3U        /* lines that the caller lends */
#define DTOF_FILTER_LEAST_OTHERS 8U /* valid pixels around a pixel, without which it keeps its depth */

/* Settings of the filter. Depths have any unit that is proportional to the distance, for example 0.1 mm. */
typedef struct {
  uint32_t tolerance; /* depths are on a surface if they differ from its depth by at most this plus ... */
  uint8_t tolerance_shift; /* ... the surface's depth / 2^tolerance_shift; at most 31 */
} dtof_filter_settings;

/* The settings for a laser whose pulse has this full width at half maximum, as a distance (half the way of
 * light) in the unit of the depths. All reports use these settings for every read-out. */
dtof_filter_settings dtof_filter_defaults(uint32_t pulse);

/* Filters a frame in place, row by row. `depths` holds rows x columns values, row by row. `lines` has room
 * for DTOF_FILTER_LINES x columns values. Returns false, without a change, for a frame without a pixel or
 * illegal settings. A depth above DTOF_FILTER_MOST_DEPTH is invalid; if it stays invalid, it becomes
 * DTOF_FILTER_INVALID. */
bool dtof_filter(const dtof_filter_settings *settings, uint16_t columns, uint16_t rows, uint32_t *depths,
                 uint32_t *lines);

#ifdef __cplusplus
}
#endif

#endif
