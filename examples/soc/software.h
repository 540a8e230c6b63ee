/* SPDX-License-Identifier: Apache-2.0
 * What the processor of the SoC example runs (docs/user/soc_example.md): a frame by the driver of
 * dtof_subsystem, driver/dtof.h. C99.
 */
#ifndef SOC_SOFTWARE_H
#define SOC_SOFTWARE_H

#include "dtof.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The address map, as in soc_address_decoder.sv. */
#define SOC_READOUT_BASE UINT32_C(0x40000000)
#define SOC_SCENE_BASE UINT32_C(0x40001000)

/* What the processor can do. On silicon `read` and `write` are accesses of volatile pointers, and
 * `wait_for_interrupt` sleeps. Each returns false if it failed. */
typedef struct {
  void *context;
  bool (*read)(void *context, uint32_t address, uint32_t *value);
  bool (*write)(void *context, uint32_t address, uint32_t value);
  bool (*wait_for_interrupt)(void *context);
} soc_platform;

/* What is known behind a frame. */
typedef struct {
  dtof_device device;
  dtof_state state;
  uint32_t causes; /* of the interrupt, DTOF_IRQ_STATUS_*_MASK; the hardware has forgotten them */
  uint32_t errors; /* DTOF_ERROR_*_MASK; likewise. OVERRUN: the source had to wait for the serial line */
} soc_frame;

/* Sets the code of a pixel's target; pixel = row * columns + column. DTOF_BUS for a pixel or a code that is
 * not there. */
dtof_status soc_set_target(soc_platform *platform, uint32_t pixel, uint32_t code);

/* Finds the read-out, sets it up, starts a frame, waits for the interrupt and reads what happened. The
 * frame's results leave over the serial line. `frame->device` refers to `platform`. */
dtof_status soc_run_frame(soc_platform *platform, uint32_t acquisitions, soc_frame *frame);

#ifdef __cplusplus
}
#endif

#endif
