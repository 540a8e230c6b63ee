/* SPDX-License-Identifier: Apache-2.0
 * Driver of dtof_subsystem: control of frames, self-test, state, errors and interrupts.
 */
#include "dtof_access.h"

#define MOST_READS_OF_AN_ABORT 100U /* it takes 16 clocks */

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
