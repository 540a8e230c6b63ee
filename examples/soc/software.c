/* SPDX-License-Identifier: Apache-2.0 */
#include "software.h"

/* The driver has offsets, the processor addresses. */
static bool read_register(void *context, uint32_t offset, uint32_t *value) {
  soc_platform *platform = context;
  return platform->read(platform->context, SOC_READOUT_BASE + offset, value);
}

static bool write_register(void *context, uint32_t offset, uint32_t value) {
  soc_platform *platform = context;
  return platform->write(platform->context, SOC_READOUT_BASE + offset, value);
}

dtof_status soc_set_target(soc_platform *platform, uint32_t pixel, uint32_t code) {
  return platform->write(platform->context, SOC_SCENE_BASE + 4 * pixel, code) ? DTOF_OK : DTOF_BUS;
}

dtof_status soc_run_frame(soc_platform *platform, uint32_t acquisitions, soc_frame *frame) {
  dtof_bus bus = {platform, read_register, write_register};
  dtof_status status = dtof_probe(&frame->device, bus);
  if (status != DTOF_OK) {
    return status;
  }
  dtof_settings settings = dtof_default_settings(&frame->device, acquisitions);
  if ((status = dtof_configure(&frame->device, &settings)) != DTOF_OK ||
      (status = dtof_enable_interrupts(&frame->device, true, false)) != DTOF_OK ||
      (status = dtof_start(&frame->device, false)) != DTOF_OK) {
    return status;
  }
  if (!platform->wait_for_interrupt(platform->context)) {
    return DTOF_BUSY;
  }
  if ((status = dtof_take_interrupts(&frame->device, &frame->causes)) != DTOF_OK ||
      (status = dtof_take_errors(&frame->device, &frame->errors)) != DTOF_OK) {
    return status;
  }
  return dtof_read_state(&frame->device, &frame->state);
}
