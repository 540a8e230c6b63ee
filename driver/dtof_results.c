/* SPDX-License-Identifier: Apache-2.0
 * Driver of dtof_subsystem: unpacks and checks the result stream, converts positions to millimetres.
 */
#include "dtof_access.h"

#define LIGHT_MM_PER_PS 0.299792458
#define SHORT_WORD_BITS 32U

/* The fields that each word of 64 bits of a first target has. */
static void take_fields(uint64_t word, dtof_result *result) {
  result->position = (uint16_t)FIELD(word, DTOF_RESULT_POSITION);
  result->confidence = (uint16_t)FIELD(word, DTOF_RESULT_CONFIDENCE);
  result->valid = FIELD(word, DTOF_RESULT_VALID) != 0;
  result->weak = FIELD(word, DTOF_RESULT_WEAK) != 0;
  result->empty = FIELD(word, DTOF_RESULT_EMPTY) != 0;
  result->masked = FIELD(word, DTOF_RESULT_MASKED) != 0;
  result->saturated = FIELD(word, DTOF_RESULT_SATURATED) != 0;
  result->raw = FIELD(word, DTOF_RESULT_RAW) != 0;
  result->has_second = false;
  result->second_position = 0;
  result->has_amplitude = false;
  result->amplitude = 0;
  result->ambient = 0;
}

dtof_status dtof_unpack(const dtof_device *device, uint64_t word, dtof_result *result) {
  if (FIELD(word, DTOF_RESULT_ABORTED) != 0) {
    return DTOF_ABORTED;
  }
  if (FIELD(word, DTOF_RESULT_SECOND) != 0) {
    result->has_second = true;
    result->second_position = (uint16_t)FIELD(word, DTOF_RESULT_POSITION);
    return result->row == FIELD(word, DTOF_RESULT_ROW) && result->column == FIELD(word, DTOF_RESULT_COLUMN)
               ? DTOF_OK
               : DTOF_STREAM;
  }
  result->row = (uint16_t)FIELD(word, DTOF_RESULT_ROW);
  result->column = (uint16_t)FIELD(word, DTOF_RESULT_COLUMN);
  take_fields(word, result);
  return result->row < device->rows && result->column < device->columns ? DTOF_OK : DTOF_STREAM;
}

dtof_status dtof_unpack_frame(const dtof_device *device, const uint64_t *words, size_t count,
                              dtof_result *results) {
  size_t pixels = (size_t)device->rows * device->columns;
  size_t words_of_a_pixel = count == pixels ? 1U : 2U;
  if (count > 0 && FIELD(words[count - 1], DTOF_RESULT_ABORTED) != 0) {
    return DTOF_ABORTED;
  }
  if (count != words_of_a_pixel * pixels) {
    return DTOF_STREAM;
  }
  /* A place that is still free has a row that no array has. */
  for (size_t i = 0; i < pixels; ++i) {
    results[i].row = UINT16_MAX;
  }
  for (size_t i = 0; i < count; i += words_of_a_pixel) {
    dtof_result result;
    result.row = UINT16_MAX;
    for (size_t k = 0; k < words_of_a_pixel; ++k) {
      dtof_status status = dtof_unpack(device, words[i + k], &result);
      if (status != DTOF_OK) {
        return status;
      }
    }
    if (result.has_second != (words_of_a_pixel == 2U) || result.raw) {
      return DTOF_STREAM;
    }
    dtof_result *place = &results[(size_t)result.row * device->columns + result.column];
    if (place->row != UINT16_MAX) {
      return DTOF_STREAM;
    }
    *place = result;
  }
  return DTOF_OK;
}

dtof_status dtof_pixel_at(const dtof_device *device, size_t index, uint16_t *row, uint16_t *column) {
  if (index >= (size_t)device->rows * device->columns) {
    return DTOF_ARGUMENT;
  }
  if (device->has_raster_order || !device->has_schedule) {
    *row = (uint16_t)(index / device->columns);
    *column = (uint16_t)(index % device->columns);
    return DTOF_OK;
  }
  /* Each turn has a column of every engine; the last engine may have no column in the later turns. */
  size_t engines = ((size_t)device->columns + device->engine_columns - 1U) / device->engine_columns;
  size_t turns_of_all = device->columns - (engines - 1U) * device->engine_columns;
  size_t pixels_of_all = turns_of_all * engines * device->rows;
  size_t turn = 0;
  if (index >= pixels_of_all) {
    index -= pixels_of_all;
    turn = turns_of_all;
    --engines;
  }
  turn += index / (engines * device->rows);
  *row = (uint16_t)(index / engines % device->rows);
  *column = (uint16_t)(index % engines * device->engine_columns + turn);
  return DTOF_OK;
}

dtof_status dtof_unpack_amplitude(uint64_t word, dtof_result *result) {
  /* A result has at least one of these bits. */
  const uint64_t status =
      DTOF_RESULT_VALID_MASK | DTOF_RESULT_WEAK_MASK | DTOF_RESULT_EMPTY_MASK | DTOF_RESULT_MASKED_MASK;
  uint16_t amplitude = (uint16_t)FIELD(word, DTOF_AMPLITUDE_RESULT_AMPLITUDE);
  uint16_t ambient = (uint16_t)FIELD(word, DTOF_AMPLITUDE_RESULT_AMBIENT);
  if (FIELD(word, DTOF_RESULT_ABORTED) != 0) {
    return DTOF_ABORTED;
  }
  if ((word & status) == 0) {
    return DTOF_STREAM;
  }
  if (FIELD(word, DTOF_RESULT_SECOND) != 0) {
    result->has_second = true;
    result->second_position = (uint16_t)FIELD(word, DTOF_RESULT_POSITION);
    return result->amplitude == amplitude && result->ambient == ambient ? DTOF_OK : DTOF_STREAM;
  }
  take_fields(word, result);
  result->has_amplitude = true;
  result->amplitude = amplitude;
  result->ambient = ambient;
  return result->raw ? DTOF_STREAM : DTOF_OK;
}

/* Takes word `index` of a frame into a result; *second: whether the word is of a second target. */
typedef dtof_status (*word_reader)(const uint64_t *words, size_t index, bool *second, dtof_result *result);

/* Unpacks words without row and column, which follow from the order. */
static dtof_status unpack_in_order(const dtof_device *device, const uint64_t *words, size_t words_of_a_pixel,
                                   word_reader take_word, dtof_result *results) {
  size_t pixels = (size_t)device->rows * device->columns;
  for (size_t i = 0; i < pixels; ++i) {
    dtof_result result = {0};
    dtof_status status = dtof_pixel_at(device, i, &result.row, &result.column);
    for (size_t k = 0; status == DTOF_OK && k < words_of_a_pixel; ++k) {
      bool second = false;
      status = take_word(words, words_of_a_pixel * i + k, &second, &result);
      status = status == DTOF_OK && second != (k == 1U) ? DTOF_STREAM : status;
    }
    if (status != DTOF_OK) {
      return status;
    }
    results[(size_t)result.row * device->columns + result.column] = result;
  }
  return DTOF_OK;
}

static dtof_status take_amplitude_word(const uint64_t *words, size_t index, bool *second,
                                       dtof_result *result) {
  *second = FIELD(words[index], DTOF_RESULT_SECOND) != 0;
  return dtof_unpack_amplitude(words[index], result);
}

dtof_status dtof_unpack_amplitude_frame(const dtof_device *device, const uint64_t *words, size_t count,
                                        dtof_result *results) {
  size_t pixels = (size_t)device->rows * device->columns;
  size_t words_of_a_pixel = count == pixels ? 1U : 2U;
  if (count > 0 && FIELD(words[count - 1], DTOF_RESULT_ABORTED) != 0) {
    return DTOF_ABORTED;
  }
  if (count != words_of_a_pixel * pixels) {
    return DTOF_STREAM;
  }
  return unpack_in_order(device, words, words_of_a_pixel, take_amplitude_word, results);
}

dtof_status dtof_unpack_short(uint32_t word, dtof_result *result) {
  /* A result has at least one of these bits. */
  const uint32_t status = DTOF_SHORT_RESULT_VALID_MASK | DTOF_SHORT_RESULT_WEAK_MASK |
                          DTOF_SHORT_RESULT_EMPTY_MASK | DTOF_SHORT_RESULT_MASKED_MASK;
  if (FIELD(word, DTOF_SHORT_RESULT_ABORTED) != 0) {
    return DTOF_ABORTED;
  }
  if ((word & status) == 0) {
    return DTOF_STREAM;
  }
  if (FIELD(word, DTOF_SHORT_RESULT_SECOND) != 0) {
    result->has_second = true;
    result->second_position = (uint16_t)FIELD(word, DTOF_SHORT_RESULT_POSITION);
    return DTOF_OK;
  }
  result->position = (uint16_t)FIELD(word, DTOF_SHORT_RESULT_POSITION);
  result->confidence = (uint16_t)FIELD(word, DTOF_SHORT_RESULT_CONFIDENCE);
  result->valid = FIELD(word, DTOF_SHORT_RESULT_VALID) != 0;
  result->weak = FIELD(word, DTOF_SHORT_RESULT_WEAK) != 0;
  result->empty = FIELD(word, DTOF_SHORT_RESULT_EMPTY) != 0;
  result->masked = FIELD(word, DTOF_SHORT_RESULT_MASKED) != 0;
  result->saturated = FIELD(word, DTOF_SHORT_RESULT_SATURATED) != 0;
  result->raw = false;
  result->has_second = false;
  result->second_position = 0;
  result->has_amplitude = false;
  result->amplitude = 0;
  result->ambient = 0;
  return DTOF_OK;
}

static uint32_t short_word(const uint64_t *words, size_t index) {
  return (uint32_t)(words[index / 2U] >> (index % 2U * SHORT_WORD_BITS));
}

static dtof_status take_short_word(const uint64_t *words, size_t index, bool *second, dtof_result *result) {
  uint32_t word = short_word(words, index);
  *second = FIELD(word, DTOF_SHORT_RESULT_SECOND) != 0;
  return dtof_unpack_short(word, result);
}

/* The word that ends an aborted frame: its highest bit is set, or that of its lower half alone, which is no
 * result either. */
static bool ends_aborted(const uint64_t *words, size_t count) {
  return count > 0 && (FIELD(words[count - 1], DTOF_RESULT_ABORTED) != 0 ||
                       words[count - 1] == DTOF_SHORT_RESULT_ABORTED_MASK);
}

dtof_status dtof_unpack_short_frame(const dtof_device *device, const uint64_t *words, size_t count,
                                    dtof_result *results) {
  size_t pixels = (size_t)device->rows * device->columns;
  if (ends_aborted(words, count)) {
    return DTOF_ABORTED;
  }
  /* In a frame with second targets the second short word is one. */
  size_t words_of_a_pixel = count > 0 && FIELD(short_word(words, 1), DTOF_SHORT_RESULT_SECOND) != 0 ? 2U : 1U;
  size_t expected = words_of_a_pixel * pixels;
  if (count != (expected + 1U) / 2U || (expected % 2U != 0 && short_word(words, expected) != 0)) {
    return DTOF_STREAM;
  }
  return unpack_in_order(device, words, words_of_a_pixel, take_short_word, results);
}

dtof_status dtof_unpack_raw(const dtof_device *device, uint16_t first_row, uint16_t last_row,
                            const uint64_t *words, size_t count, dtof_result *bins) {
  if (first_row > last_row || last_row >= device->rows ||
      count != (size_t)(last_row - first_row + 1) * device->raw_bins * device->columns) {
    return DTOF_STREAM;
  }
  size_t taken = 0;
  for (uint32_t row = first_row; row <= last_row; ++row) {
    for (size_t bin = 0; bin < device->raw_bins; ++bin) {
      for (size_t column = 0; column < device->columns; ++column) {
        dtof_result result;
        result.row = UINT16_MAX;
        dtof_status status = dtof_unpack(device, words[taken++], &result);
        if (status != DTOF_OK || !result.raw || result.row != row || result.column != column) {
          return DTOF_STREAM;
        }
        bins[((row - first_row) * device->columns + column) * device->raw_bins + bin] = result;
      }
    }
  }
  return DTOF_OK;
}

dtof_result dtof_second(const dtof_result *result) {
  dtof_result second = *result;
  second.position = result->second_position;
  second.has_second = false;
  second.second_position = 0;
  return second;
}

static double code_of(const dtof_device *device, const dtof_result *result) {
  return (double)result->position / (double)(UINT32_C(1) << device->fraction_bits);
}

static double line(dtof_point from, double slope, double position) {
  return from.distance_mm + slope * (position - from.position);
}

static double slope_between(dtof_point from, dtof_point to) {
  return (to.distance_mm - from.distance_mm) / (to.position - from.position);
}

double dtof_distance_mm(const dtof_device *device, const dtof_result *result, const dtof_point *table,
                        size_t count) {
  double position = code_of(device, result);
  dtof_point first = table[0];
  dtof_point last = table[count - 1];
  if (count == 1) {
    return first.distance_mm;
  }
  if (position <= first.position) {
    return line(first, slope_between(first, last), position);
  }
  if (position >= last.position) {
    return line(last, slope_between(first, last), position);
  }
  /* The last point that is not above lies in [low, high). */
  size_t low = 0;
  size_t high = count - 1;
  while (high - low > 1) {
    size_t middle = low + (high - low) / 2;
    if (table[middle].position <= position) {
      low = middle;
    } else {
      high = middle;
    }
  }
  return line(table[low], slope_between(table[low], table[high]), position);
}

double dtof_time_of_flight_mm(const dtof_device *device, const dtof_result *result, double code_ps,
                              double fwhm_ps) {
  return LIGHT_MM_PER_PS / 2.0 * (code_ps * (code_of(device, result) + 0.5) - fwhm_ps);
}

uint32_t dtof_crc(const uint64_t *words, size_t count) {
  /* By halves of a byte: what four bits add to the remainder. */
  static const uint32_t halves[] = {
      UINT32_C(0x00000000), UINT32_C(0x1DB71064), UINT32_C(0x3B6E20C8), UINT32_C(0x26D930AC),
      UINT32_C(0x76DC4190), UINT32_C(0x6B6B51F4), UINT32_C(0x4DB26158), UINT32_C(0x5005713C),
      UINT32_C(0xEDB88320), UINT32_C(0xF00F9344), UINT32_C(0xD6D6A3E8), UINT32_C(0xCB61B38C),
      UINT32_C(0x9B64C2B0), UINT32_C(0x86D3D2D4), UINT32_C(0xA00AE278), UINT32_C(0xBDBDF21C)};
  uint32_t crc = UINT32_MAX;
  for (size_t i = 0; i < count; ++i) {
    for (unsigned bit = 0; bit < 64U; bit += 4U) {
      crc = crc >> 4 ^ halves[(crc ^ (uint32_t)(words[i] >> bit)) & 15U];
    }
  }
  return ~crc;
}

dtof_status dtof_check_frame(const dtof_device *device, const uint64_t *words, size_t count,
                             uint32_t *frame) {
  uint32_t crc = 0;
  uint32_t later = 0;
  if (ends_aborted(words, count)) {
    return DTOF_ABORTED;
  }
  dtof_status status = read_register(device, DTOF_FRAME_COUNT, frame);
  if (status == DTOF_OK) {
    status = read_register(device, DTOF_FRAME_CRC, &crc);
  }
  if (status == DTOF_OK) {
    status = read_register(device, DTOF_FRAME_COUNT, &later);
  }
  if (status != DTOF_OK) {
    return status;
  }
  if (later != *frame) {
    return DTOF_BUSY;
  }
  return crc == dtof_crc(words, count) ? DTOF_OK : DTOF_CORRUPT;
}
