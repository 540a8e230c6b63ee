/* SPDX-License-Identifier: Apache-2.0 */
#include "dtof.h"

#define WHOLE_FRAME 64U /* a frame in 64ths */
#define LIGHT_MM_PER_PS 0.299792458
#define COLUMNS_OF_A_WORD 32U
#define SHORT_WORD_BITS 32U
#define MOST_READS_OF_AN_ABORT 100U /* it takes 16 clocks */

static dtof_status read_register(const dtof_device *device, uint32_t offset, uint32_t *value) {
  return device->bus.read(device->bus.context, offset, value) ? DTOF_OK : DTOF_BUS;
}

static dtof_status write_register(const dtof_device *device, uint32_t offset, uint32_t value) {
  return device->bus.write(device->bus.context, offset, value) ? DTOF_OK : DTOF_BUS;
}

static uint32_t most_lines(const dtof_device *device) {
  if (device->clock_waits) {
    return device->acquisition_lines;
  }
  return device->buffer_lines < device->acquisition_lines ? device->buffer_lines : device->acquisition_lines;
}

#define FIELD(value, name) (((value)&name##_MASK) >> name##_LSB)

dtof_status dtof_probe(dtof_device *device, dtof_bus bus) {
  static const uint32_t offsets[] = {DTOF_ID,    DTOF_VERSION, DTOF_READOUT,  DTOF_SIZE,      DTOF_WIDTHS,
                                     DTOF_LINES, DTOF_SLOTS,   DTOF_RAW_BINS, DTOF_HISTOGRAM, DTOF_POINTER,
                                     DTOF_POOL,  DTOF_ENGINES, DTOF_SHARES};
  enum {
    ID,
    VERSION,
    READOUT,
    SIZE,
    WIDTHS,
    LINES,
    SLOTS,
    RAW_BINS,
    HISTOGRAM,
    POINTER,
    POOL,
    ENGINES,
    SHARES,
    REGISTERS
  };
  uint32_t values[REGISTERS];

  device->bus = bus;
  for (size_t i = 0; i < REGISTERS; ++i) {
    dtof_status status = read_register(device, offsets[i], &values[i]);
    if (status != DTOF_OK) {
      return status;
    }
    if (i == ID && values[ID] != DTOF_ID_EXPECTED) {
      return DTOF_NOT_FOUND;
    }
    if (i == VERSION && (FIELD(values[VERSION], DTOF_VERSION_MAJOR) != DTOF_VERSION_MAJOR_EXPECTED ||
                         FIELD(values[VERSION], DTOF_VERSION_MINOR) < DTOF_VERSION_MINOR_EXPECTED)) {
      return DTOF_VERSION_UNKNOWN;
    }
  }
  device->readout = (uint8_t)FIELD(values[READOUT], DTOF_READOUT_NUMBER);
  device->has_schedule = FIELD(values[READOUT], DTOF_READOUT_SCHEDULE) != 0;
  device->has_gate = FIELD(values[READOUT], DTOF_READOUT_TIME_GATE) != 0;
  device->has_raster_order = FIELD(values[READOUT], DTOF_READOUT_RASTER_ORDER) != 0;
  device->has_raw_histogram = FIELD(values[READOUT], DTOF_READOUT_RAW_HISTOGRAM) != 0;
  device->raw_bins = FIELD(values[RAW_BINS], DTOF_RAW_BINS_VALUE);
  device->has_second_target = FIELD(values[READOUT], DTOF_READOUT_SECOND_TARGET) != 0;
  device->has_amplitude = FIELD(values[READOUT], DTOF_READOUT_AMPLITUDE) != 0;
  device->has_prior = FIELD(values[READOUT], DTOF_READOUT_PRIOR) != 0;
  device->has_parity = FIELD(values[READOUT], DTOF_READOUT_PARITY) != 0;
  device->has_self_test = FIELD(values[READOUT], DTOF_READOUT_SELF_TEST) != 0;
  device->clock_waits = FIELD(values[READOUT], DTOF_READOUT_CLOCK_WAITS) != 0;
  device->source_waits = FIELD(values[READOUT], DTOF_READOUT_SOURCE_WAITS) != 0;
  device->columns = (uint16_t)FIELD(values[SIZE], DTOF_SIZE_COLUMNS);
  device->rows = (uint16_t)FIELD(values[SIZE], DTOF_SIZE_ROWS);
  device->timestamp_bits = (uint8_t)FIELD(values[WIDTHS], DTOF_WIDTHS_TIMESTAMP);
  device->fraction_bits = (uint8_t)FIELD(values[WIDTHS], DTOF_WIDTHS_FRACTION);
  device->confidence_bits = (uint8_t)FIELD(values[WIDTHS], DTOF_WIDTHS_CONFIDENCE);
  device->acquisition_bits = (uint8_t)FIELD(values[WIDTHS], DTOF_WIDTHS_ACQUISITIONS);
  device->acquisition_lines = (uint16_t)FIELD(values[LINES], DTOF_LINES_ACQUISITION);
  device->buffer_lines = (uint16_t)FIELD(values[LINES], DTOF_LINES_BUFFER);
  device->slots = (uint8_t)FIELD(values[SLOTS], DTOF_SLOTS_VALUE);
  device->count_width = (uint8_t)FIELD(values[HISTOGRAM], DTOF_HISTOGRAM_COUNT_WIDTH);
  device->nb = (uint8_t)FIELD(values[HISTOGRAM], DTOF_HISTOGRAM_NB);
  device->window_centred = FIELD(values[HISTOGRAM], DTOF_HISTOGRAM_WINDOW_CENTRED) != 0;
  device->pointer_step = (uint16_t)FIELD(values[POINTER], DTOF_POINTER_STEP);
  device->guard = FIELD(values[POINTER], DTOF_POINTER_GUARD);
  device->group_size = (uint8_t)FIELD(values[POOL], DTOF_POOL_GROUP_SIZE);
  device->labels = (uint8_t)FIELD(values[POOL], DTOF_POOL_LABELS);
  device->score_bits = (uint8_t)FIELD(values[POOL], DTOF_POOL_SCORE_BITS);
  device->offset_bits = (uint8_t)FIELD(values[POOL], DTOF_POOL_OFFSET_BITS);
  device->advantage_width = (uint8_t)FIELD(values[POOL], DTOF_POOL_ADVANTAGE_WIDTH);
  device->pointer_shift = (uint8_t)FIELD(values[POOL], DTOF_POOL_POINTER_SHIFT);
  device->cell_shift = (uint8_t)FIELD(values[POOL], DTOF_POOL_CELL_SHIFT);
  device->rival_moves = FIELD(values[ENGINES], DTOF_ENGINES_RIVAL_MOVES) != 0;
  device->engine_columns = (uint16_t)FIELD(values[ENGINES], DTOF_ENGINES_COLUMNS);
  device->coarse_share = (uint8_t)FIELD(values[SHARES], DTOF_SHARES_COARSE);
  device->track_share = (uint8_t)FIELD(values[SHARES], DTOF_SHARES_TRACK);
  return DTOF_OK;
}

dtof_settings dtof_default_settings(const dtof_device *device, uint32_t acquisitions) {
  dtof_settings settings = {0};
  settings.acquisitions = acquisitions;
  settings.coarse_share = device->coarse_share;
  settings.track_share = device->track_share;
  settings.smooth = true;
  settings.gate_end = (uint16_t)((UINT32_C(1) << device->timestamp_bits) - 1U);
  settings.shot_unit = 1;
  return settings;
}

dtof_status dtof_configure(const dtof_device *device, const dtof_settings *settings) {
  uint32_t codes = (UINT32_C(1) << device->timestamp_bits) - 1U;
  uint32_t confidences = UINT32_C(1) << device->confidence_bits;
  uint32_t release = settings->release == 0 ? most_lines(device) : settings->release;
  uint32_t shares = (uint32_t)settings->coarse_share + settings->track_share;

  if (settings->acquisitions >> device->acquisition_bits != 0 || release > most_lines(device) ||
      settings->weak_below > confidences ||
      settings->shot_bits > (DTOF_SHOT_BITS_MASK >> DTOF_SHOT_BITS_LSB) ||
      (device->has_gate && (settings->gate_begin > codes || settings->gate_end > codes)) ||
      (device->has_schedule && shares > WHOLE_FRAME) ||
      (settings->second_target && !device->has_second_target) ||
      (settings->amplitude && !device->has_amplitude) || (settings->prior && !device->has_prior) ||
      (settings->raw && (!device->has_raw_histogram || settings->raw_first_row > settings->raw_last_row ||
                         settings->raw_last_row >= device->rows))) {
    return DTOF_ARGUMENT;
  }

  struct {
    uint32_t offset;
    uint32_t value;
    bool there;
  } writes[] = {
      {DTOF_ACQUISITIONS, settings->acquisitions, true},
      {DTOF_COARSE_END, 0, device->has_schedule},
      {DTOF_TRACK_END, 0, device->has_schedule},
      {DTOF_GATE,
       (uint32_t)settings->gate_begin << DTOF_GATE_BEGIN_LSB | (uint32_t)settings->gate_end
                                                                   << DTOF_GATE_END_LSB,
       device->has_gate},
      {DTOF_RELEASE, release, true},
      {DTOF_WEAK_BELOW, settings->weak_below, true},
      {DTOF_SHOT,
       (uint32_t)settings->shot_bits << DTOF_SHOT_BITS_LSB | (uint32_t)settings->shot_unit
                                                                 << DTOF_SHOT_UNIT_LSB,
       true},
      {DTOF_SETTLE, settings->settle, true},
      {DTOF_OUTPUT,
       (settings->second_target ? DTOF_OUTPUT_SECOND_TARGET_MASK : 0U) |
           (settings->raw ? DTOF_OUTPUT_RAW_MASK : 0U) |
           (settings->smooth && device->has_schedule ? DTOF_OUTPUT_SMOOTH_MASK : 0U) |
           (settings->prior ? DTOF_OUTPUT_PRIOR_MASK : 0U) |
           (settings->amplitude ? DTOF_OUTPUT_AMPLITUDE_MASK : 0U) |
           (settings->short_words ? DTOF_OUTPUT_SHORT_WORDS_MASK : 0U),
       true},
      {DTOF_RAW_ROWS,
       (uint32_t)settings->raw_first_row << DTOF_RAW_ROWS_FIRST_LSB | (uint32_t)settings->raw_last_row
                                                                          << DTOF_RAW_ROWS_LAST_LSB,
       settings->raw},
  };
  writes[1].value = (uint32_t)((uint64_t)settings->acquisitions * settings->coarse_share / WHOLE_FRAME);
  writes[2].value = (uint32_t)((uint64_t)settings->acquisitions * shares / WHOLE_FRAME);

  for (size_t i = 0; i < sizeof writes / sizeof writes[0]; ++i) {
    if (writes[i].there) {
      dtof_status status = write_register(device, writes[i].offset, writes[i].value);
      if (status != DTOF_OK) {
        return status;
      }
    }
  }
  return DTOF_OK;
}

dtof_status dtof_enable_columns(const dtof_device *device, const uint32_t *mask) {
  for (uint32_t word = 0; word * COLUMNS_OF_A_WORD < device->columns; ++word) {
    uint32_t columns = device->columns - word * COLUMNS_OF_A_WORD;
    uint32_t there = columns < COLUMNS_OF_A_WORD ? (UINT32_C(1) << columns) - 1U : UINT32_MAX;
    dtof_status status = write_register(device, DTOF_COLUMN_ENABLE + 4U * word, mask[word] & there);
    if (status != DTOF_OK) {
      return status;
    }
  }
  return DTOF_OK;
}

dtof_status dtof_set_template(const dtof_device *device, const uint8_t entries[DTOF_TEMPLATE_ENTRIES]) {
  if (!device->has_schedule) {
    return DTOF_ARGUMENT;
  }
  for (uint32_t i = 0; i < DTOF_TEMPLATE_ENTRIES; i += 4U) {
    uint32_t word = (uint32_t)entries[i] | (uint32_t)entries[i + 1U] << 8 | (uint32_t)entries[i + 2U] << 16 |
                    (uint32_t)entries[i + 3U] << 24;
    dtof_status status = write_register(device, DTOF_TEMPLATE + i, word);
    if (status != DTOF_OK) {
      return status;
    }
  }
  return DTOF_OK;
}

dtof_status dtof_commit(const dtof_device *device) {
  return write_register(device, DTOF_COMMIT, DTOF_COMMIT_SETTINGS_MASK);
}

dtof_status dtof_set_watchdog(const dtof_device *device, uint32_t clocks) {
  return clocks > DTOF_WATCHDOG_CLOCKS_MASK ? DTOF_ARGUMENT : write_register(device, DTOF_WATCHDOG, clocks);
}

dtof_status dtof_seed_shots(const dtof_device *device, uint32_t seed) {
  return seed == 0 || seed > DTOF_SHOT_SEED_VALUE_MASK ? DTOF_ARGUMENT
                                                       : write_register(device, DTOF_SHOT_SEED, seed);
}

uint32_t dtof_shot_seed(uint32_t serial_number) {
  /* MurmurHash3's last step, which maps different numbers to different ones; the upper half of them. */
  uint32_t mixed = serial_number;
  mixed = (mixed ^ mixed >> 16) * UINT32_C(0x85EBCA6B);
  mixed = (mixed ^ mixed >> 13) * UINT32_C(0xC2B2AE35);
  mixed = (mixed ^ mixed >> 16) >> 16;
  return mixed == 0 ? 1U : mixed;
}

dtof_status dtof_read_shot_state(const dtof_device *device, uint32_t *state) {
  return read_register(device, DTOF_SHOT_STATE, state);
}

dtof_status dtof_enable_interrupts(const dtof_device *device, bool frame, bool error) {
  return write_register(
      device, DTOF_IRQ_ENABLE,
      (frame ? DTOF_IRQ_ENABLE_FRAME_MASK : 0U) | (error ? DTOF_IRQ_ENABLE_ERROR_MASK : 0U));
}

dtof_status dtof_busy(const dtof_device *device, bool *busy) {
  uint32_t value = 0;
  dtof_status status = read_register(device, DTOF_STATUS, &value);
  *busy = FIELD(value, DTOF_STATUS_BUSY) != 0;
  return status;
}

/* A command, unless a frame is under way. */
static dtof_status command(const dtof_device *device, uint32_t value) {
  bool busy = false;
  dtof_status status = dtof_busy(device, &busy);
  if (status != DTOF_OK) {
    return status;
  }
  return busy ? DTOF_BUSY : write_register(device, DTOF_CONTROL, value);
}

dtof_status dtof_start(const dtof_device *device, bool continuous) {
  return command(device, DTOF_CONTROL_START_MASK | (continuous ? DTOF_CONTROL_CONTINUOUS_MASK : 0U));
}

dtof_status dtof_stop(const dtof_device *device) { return write_register(device, DTOF_CONTROL, 0); }

dtof_status dtof_flush(const dtof_device *device) { return command(device, DTOF_CONTROL_FLUSH_MASK); }

dtof_status dtof_abort(const dtof_device *device, bool source_stopped) {
  dtof_status status = write_register(
      device, DTOF_CONTROL, DTOF_CONTROL_ABORT_MASK | (source_stopped ? DTOF_CONTROL_FLUSH_MASK : 0U));
  bool busy = true;
  for (uint32_t i = 0; status == DTOF_OK && busy; ++i) {
    status = i < MOST_READS_OF_AN_ABORT ? dtof_busy(device, &busy) : DTOF_BUSY;
  }
  return status;
}

dtof_status dtof_recover(const dtof_device *device) {
  static const uint32_t sticky[] = {DTOF_ERROR, DTOF_WARNING, DTOF_IRQ_STATUS};
  dtof_status status = dtof_abort(device, true);
  for (size_t i = 0; status == DTOF_OK && i < sizeof sticky / sizeof sticky[0]; ++i) {
    status = write_register(device, sticky[i], UINT32_MAX);
  }
  return status;
}

dtof_status dtof_self_test(const dtof_device *device, uint32_t seed, uint32_t expected, uint32_t most_reads) {
  uint32_t state = DTOF_STATUS_BUSY_MASK;
  uint32_t errors = 0;
  bool busy = false;
  if (!device->has_self_test) {
    return DTOF_ARGUMENT;
  }
  dtof_status status = dtof_busy(device, &busy);
  if (status != DTOF_OK || busy) {
    return status != DTOF_OK ? status : DTOF_BUSY;
  }
  struct {
    uint32_t offset;
    uint32_t value;
  } writes[] = {{DTOF_SELF_TEST_SEED, seed},
                {DTOF_SELF_TEST_EXPECTED, expected},
                {DTOF_ERROR, DTOF_ERROR_SELF_TEST_MASK | (device->has_parity ? DTOF_ERROR_PARITY_MASK : 0U)},
                {DTOF_CONTROL, DTOF_CONTROL_SELF_TEST_MASK}};
  for (size_t i = 0; status == DTOF_OK && i < sizeof writes / sizeof writes[0]; ++i) {
    status = write_register(device, writes[i].offset, writes[i].value);
  }
  for (uint32_t i = 0; status == DTOF_OK && FIELD(state, DTOF_STATUS_BUSY) != 0; ++i) {
    status = i < most_reads ? read_register(device, DTOF_STATUS, &state) : DTOF_BUSY;
  }
  if (status == DTOF_OK) {
    status = read_register(device, DTOF_ERROR, &errors);
  }
  if (status == DTOF_OK) {
    const bool damaged = device->has_parity && FIELD(errors, DTOF_ERROR_PARITY) != 0;
    if (FIELD(errors, DTOF_ERROR_SELF_TEST) != 0 || damaged) {
      status = DTOF_FAILED;
    } else if (FIELD(state, DTOF_STATUS_PASSED) == 0) {
      status = DTOF_BUSY;
    }
  }
  return status;
}

dtof_status dtof_read_state(const dtof_device *device, dtof_state *state) {
  static const uint32_t offsets[] = {DTOF_STATUS,       DTOF_ERROR,      DTOF_WARNING,
                                     DTOF_FRAME_COUNT,  DTOF_LOST_LINES, DTOF_LOST_ACQUISITIONS,
                                     DTOF_PARITY_ERRORS};
  uint32_t values[sizeof offsets / sizeof offsets[0]];
  for (size_t i = 0; i < sizeof offsets / sizeof offsets[0]; ++i) {
    dtof_status status = read_register(device, offsets[i], &values[i]);
    if (status != DTOF_OK) {
      return status;
    }
  }
  state->busy = FIELD(values[0], DTOF_STATUS_BUSY) != 0;
  state->array_state = (uint8_t)FIELD(values[0], DTOF_STATUS_STATE);
  state->level = (uint16_t)FIELD(values[0], DTOF_STATUS_LEVEL);
  state->errors = values[1];
  state->warnings = values[2];
  state->frames = values[3];
  state->lost_lines = values[4];
  state->lost_acquisitions = values[5];
  state->parity_errors = values[6];
  return DTOF_OK;
}

dtof_status dtof_frames(const dtof_device *device, uint32_t *frames, uint32_t *cycles) {
  dtof_status status = read_register(device, DTOF_FRAME_COUNT, frames);
  return status == DTOF_OK ? read_register(device, DTOF_FRAME_CYCLES, cycles) : status;
}

/* Reads sticky bits and clears those that were read: one that comes meanwhile stays. */
static dtof_status take(const dtof_device *device, uint32_t offset, uint32_t *bits) {
  dtof_status status = read_register(device, offset, bits);
  return status == DTOF_OK && *bits != 0 ? write_register(device, offset, *bits) : status;
}

dtof_status dtof_take_errors(const dtof_device *device, uint32_t *errors) {
  return take(device, DTOF_ERROR, errors);
}

dtof_status dtof_take_warnings(const dtof_device *device, uint32_t *warnings) {
  return take(device, DTOF_WARNING, warnings);
}

dtof_status dtof_take_interrupts(const dtof_device *device, uint32_t *causes) {
  return take(device, DTOF_IRQ_STATUS, causes);
}

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
  uint16_t amplitude = (uint16_t)FIELD(word, DTOF_AMPLITUDE_RESULT_AMPLITUDE);
  uint16_t ambient = (uint16_t)FIELD(word, DTOF_AMPLITUDE_RESULT_AMBIENT);
  if (FIELD(word, DTOF_RESULT_ABORTED) != 0) {
    return DTOF_ABORTED;
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
      status = second == (k == 1U) ? status : DTOF_STREAM;
    }
    if (status != DTOF_OK) {
      return DTOF_STREAM;
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
