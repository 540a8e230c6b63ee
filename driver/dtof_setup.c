/* SPDX-License-Identifier: Apache-2.0
 * Driver of dtof_subsystem: the parameters of the hardware, and settings.
 */
#include "dtof_access.h"

#define WHOLE_FRAME 64U /* a frame in 64ths */
#define COLUMNS_OF_A_WORD 32U

static uint32_t most_lines(const dtof_device *device) {
  if (device->clock_waits) {
    return device->acquisition_lines;
  }
  return device->buffer_lines < device->acquisition_lines ? device->buffer_lines : device->acquisition_lines;
}

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
