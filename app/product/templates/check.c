/* SPDX-License-Identifier: Apache-2.0
 * The look-up table of dtof_product.h: ascending, and dtof_distance_mm gives its points. */
#include <stdio.h>

#include "dtof.h"
#include "dtof_product.h"

int main(void) {
  dtof_device device = {0};
  device.timestamp_bits = DTOF_PRODUCT_TIMESTAMP_BITS;
  device.fraction_bits = DTOF_PRODUCT_FRACTION_BITS;
  for (size_t i = 0; i < DTOF_PRODUCT_POINTS; ++i) {
    const dtof_point *point = &dtof_product_table[i];
    if (i > 0 && (point->position <= point[-1].position || point->distance_mm <= point[-1].distance_mm)) {
      printf("FAIL: point %u of the table does not ascend\n", (unsigned)i);
      return 1;
    }
    dtof_result result = {0};
    double units = point->position * (double)(1UL << DTOF_PRODUCT_FRACTION_BITS);
    result.position = (uint16_t)(units < 0.0 ? 0.0 : units);
    double back = dtof_distance_mm(&device, &result, dtof_product_table, DTOF_PRODUCT_POINTS);
    if (!(back == back)) {
      printf("FAIL: point %u of the table has no distance\n", (unsigned)i);
      return 1;
    }
  }
  dtof_settings settings = dtof_product_settings(&device);
  if (settings.acquisitions != DTOF_PRODUCT_ACQUISITIONS) {
    printf("FAIL: the settings have other acquisitions\n");
    return 1;
  }
#ifdef DTOF_PRODUCT_SELF_TEST_EXPECTED
  if (dtof_product_self_test_settings(&device).acquisitions != DTOF_PRODUCT_SELF_TEST_ACQUISITIONS) {
    printf("FAIL: the settings of the self-test have other acquisitions\n");
    return 1;
  }
#endif
  printf("driver: %u points from %.0f to %.0f mm, %lu acquisitions a frame\n", (unsigned)DTOF_PRODUCT_POINTS,
         dtof_product_table[0].distance_mm, dtof_product_table[DTOF_PRODUCT_POINTS - 1].distance_mm,
         (unsigned long)settings.acquisitions);
  return 0;
}
