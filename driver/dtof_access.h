/* SPDX-License-Identifier: Apache-2.0
 * Access to the registers and to their fields, for the driver's own files.
 */
#ifndef DTOF_ACCESS_H
#define DTOF_ACCESS_H

#include "dtof.h"

#define FIELD(value, name) (((value)&name##_MASK) >> name##_LSB)

static inline dtof_status read_register(const dtof_device *device, uint32_t offset, uint32_t *value) {
  return device->bus.read(device->bus.context, offset, value) ? DTOF_OK : DTOF_BUS;
}

static inline dtof_status write_register(const dtof_device *device, uint32_t offset, uint32_t value) {
  return device->bus.write(device->bus.context, offset, value) ? DTOF_OK : DTOF_BUS;
}

#endif
