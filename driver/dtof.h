/* SPDX-License-Identifier: Apache-2.0
 * Driver of dtof_subsystem (docs/user/registers.md). It configures the subsystem, starts frames, unpacks
 * the result stream and converts positions to millimetres. C99, without dependencies and without memory of
 * its own: the caller owns the structure of a device.
 */
#ifndef DTOF_H
#define DTOF_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "dtof_registers.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The return value of a function: 0, or the kind of error. */
typedef enum {
  DTOF_OK = 0,
  DTOF_BUS = -1,             /* an access of the bus failed */
  DTOF_NOT_FOUND = -2,       /* register ID has another value */
  DTOF_VERSION_UNKNOWN = -3, /* another major version, or a minor version without registers that are needed */
  DTOF_ARGUMENT = -4,        /* a value that the hardware cannot take */
  DTOF_BUSY = -5,            /* a frame is under way */
  DTOF_STREAM = -6,          /* the words do not fit the array or the order of the stream */
  DTOF_ABORTED = -7,         /* the frame was aborted: its words end here */
  DTOF_CORRUPT = -8,         /* the words are not those that were sent */
  DTOF_FAILED = -9           /* the hardware has failed its self-test */
} dtof_status;

/* The caller's functions that access a register. They return false if the access failed. `offset` is in
 * bytes. */
typedef struct {
  void *context;
  bool (*read)(void *context, uint32_t offset, uint32_t *value);
  bool (*write)(void *context, uint32_t offset, uint32_t value);
} dtof_bus;

/* Parameters of the hardware, read from its registers. */
typedef struct {
  dtof_bus bus;
  uint16_t columns;
  uint16_t rows;
  uint8_t slots;
  uint8_t readout; /* the parameter READOUT */
  uint8_t timestamp_bits;
  uint8_t fraction_bits;   /* of a position */
  uint8_t confidence_bits; /* 0: the read-out has no confidence */
  uint8_t acquisition_bits;
  bool has_schedule; /* poolPointer */
  bool has_gate;
  bool has_raster_order; /* results come row by row */
  bool has_second_target;
  bool has_amplitude;
  bool has_prior;
  bool has_raw_histogram;
  bool has_parity; /* of the words in all SRAMs */
  bool has_self_test;
  bool clock_waits;  /* the array waits for a line that is late inside an acquisition */
  bool source_waits; /* false: acquisitions for which there is no room are dropped */
  uint32_t raw_bins; /* bins of a raw histogram; 0 if has_raw_histogram is false */
  uint16_t acquisition_lines;
  uint16_t buffer_lines;
  /* Parameters of the same names. A parameter that the read-out does not use has no meaning. */
  uint8_t count_width;
  uint8_t nb;
  bool window_centred;
  uint16_t pointer_step;
  uint32_t guard;
  /* Parameters of poolPointer, in which lean differs; 0 if has_schedule is false. */
  uint8_t group_size;
  uint8_t labels;
  uint8_t score_bits;
  uint8_t offset_bits;
  uint8_t advantage_width;
  uint8_t pointer_shift;
  uint8_t cell_shift;
  bool rival_moves;
  uint16_t engine_columns;
  uint8_t coarse_share; /* recommended, in 64ths of a frame */
  uint8_t track_share;
} dtof_device;

/* Settings of a frame. */
typedef struct {
  uint32_t acquisitions;
  uint8_t coarse_share; /* poolPointer: 64ths of the frame for the coarse and the track phase, at most 64
                           together */
  uint8_t track_share;
  uint16_t gate_begin; /* a timestamp from begin to below end counts; ignored if has_gate is false */
  uint16_t gate_end;
  uint16_t weak_below; /* a result with a confidence below this is weak */
  bool second_target;  /* also send each pixel's second target; DTOF_ARGUMENT if has_second_target is false */
  bool smooth; /* poolPointer: S1, moves neighbours on one surface closer together; otherwise ignored */
  bool prior;  /* the last frame's used candidates get a bonus; DTOF_ARGUMENT if has_prior is false */
  bool raw;    /* histograms of these rows instead of results; DTOF_ARGUMENT without has_raw_histogram */
  uint16_t raw_first_row;
  uint16_t raw_last_row;
  uint16_t release; /* clock_waits: lines of an acquisition that come before the shot of the next; else: lines
                       in the buffer before an acquisition begins; 0: as many as possible */
  uint8_t
      shot_bits; /* start dither: shot_o is delayed by 0 to 2^shot_bits - 1 units; at most 7; 0: no delay */
  uint8_t shot_unit; /* clocks of a unit */
  uint16_t settle;  /* acquisitions at the frame's start that are dropped, before the first one that counts */
  bool amplitude;   /* words with amplitude and ambient in place of row and column; no effect on short words;
                       DTOF_ARGUMENT if has_amplitude is false */
  bool short_words; /* results of 32 bits, two in each word of the stream; without effect on raw frames */
} dtof_settings;

/* State and errors of the device. Reading them clears nothing. */
typedef struct {
  bool busy;                  /* a frame is under way */
  uint8_t array_state;        /* state_o of the array */
  uint16_t level;             /* lines in the line buffer */
  uint32_t errors;            /* DTOF_ERROR_*_MASK */
  uint32_t warnings;          /* DTOF_WARNING_*_MASK */
  uint32_t frames;            /* since reset, modulo 2^32 */
  uint32_t lost_lines;        /* since reset, at most 2^32 - 1 */
  uint32_t lost_acquisitions; /* since reset, at most 2^32 - 1 */
  uint32_t parity_errors;     /* since reset, at most 2^32 - 1; 0 if has_parity is false */
} dtof_state;

/* One pixel's result. */
typedef struct {
  uint16_t row;
  uint16_t column;
  uint16_t position; /* code and below it the fraction: units of 2^-fraction_bits code */
  uint16_t confidence;
  bool valid; /* neither weak nor empty nor masked */
  bool weak;
  bool empty;     /* confidence 0 */
  bool masked;    /* the column is not enabled */
  bool saturated; /* the confidence has its largest value: the true count may be larger */
  bool raw;       /* a bin of a raw histogram: its lowest code and, as the confidence, its count */
  bool has_second;
  uint16_t second_position; /* where has_second: of the pixel's second target */
  bool has_amplitude;
  uint16_t amplitude; /* where has_amplitude: counts of the target; 0 if they are not known */
  uint16_t ambient;   /* where has_amplitude: background of the pixel's group */
} dtof_result;

/* A point of a look-up table: the distance at a position in codes. */
typedef struct {
  double position;
  double distance_mm;
} dtof_point;

/* Checks that there is a subsystem on the bus, and reads its parameters into *device. */
dtof_status dtof_probe(dtof_device *device, dtof_bus bus);

/* Settings for this device, for any number of acquisitions: every timestamp counts, S1 of poolPointer is on,
 * and poolPointer's schedule is the one that the device recommends. */
dtof_settings dtof_default_settings(const dtof_device *device, uint32_t acquisitions);

/* Writes the settings. They become valid with the next dtof_commit or dtof_start, for the frames that begin
 * after it. Returns DTOF_ARGUMENT, and writes nothing, if the hardware cannot take a setting. */
dtof_status dtof_configure(const dtof_device *device, const dtof_settings *settings);

/* Enables the columns whose bit in `mask` is set. `mask` has (columns + 31) / 32 words of 32 columns, column
 * 0 in the lowest bit. Becomes valid like the settings of dtof_configure. */
dtof_status dtof_enable_columns(const dtof_device *device, const uint32_t *mask);

#define DTOF_TEMPLATE_ENTRIES 32

/* poolPointer: sets the amount that decode subtracts from each coarse bin, for light of cover glass and fog;
 * all 0 after reset. Valid at once. Call it only between frames: during a frame the bus refuses the write,
 * and nothing changes. DTOF_ARGUMENT for a device without has_schedule. docs/reference/poolpointer.md,
 * Template, defines the entries. */
dtof_status dtof_set_template(const dtof_device *device, const uint8_t entries[DTOF_TEMPLATE_ENTRIES]);

/* Makes all written settings valid together, for the frames that begin after this call. Needed in continuous
 * mode. */
dtof_status dtof_commit(const dtof_device *device);

/* Restarts the sequence of start dither's delays at `seed`, at once. Sensors with equal seeds have equal
 * delays, so give each sensor another seed. DTOF_ARGUMENT if `seed` is not 1 to 65535. */
dtof_status dtof_seed_shots(const dtof_device *device, uint32_t seed);

/* A seed for the sensor with this serial number: neighbouring numbers give seeds that are far apart. */
uint32_t dtof_shot_seed(uint32_t serial_number);

/* Reads the state of the shift register at the begin of the last frame that began. With this state as their
 * seed, the models have the same delays. */
dtof_status dtof_read_shot_state(const dtof_device *device, uint32_t *state);

/* Sets how many clocks a frame waits for a line before its rest counts as no detection; 0: without a limit.
 * Valid at once. The reset value is 2^24 - 1; DTOF_ARGUMENT above it. */
dtof_status dtof_set_watchdog(const dtof_device *device, uint32_t clocks);

/* Enables the interrupt for the end of a frame (the last result was taken), for errors, for both or for
 * neither. */
dtof_status dtof_enable_interrupts(const dtof_device *device, bool frame, bool error);

/* Begins a frame, or continuous mode. DTOF_BUSY while a frame is under way. */
dtof_status dtof_start(const dtof_device *device, bool continuous);

/* Ends continuous mode; the present frame is the last one. */
dtof_status dtof_stop(const dtof_device *device);

/* Empties the line buffer. DTOF_BUSY while a frame is under way. */
dtof_status dtof_flush(const dtof_device *device);

/* Ends the present frame in any state, and continuous mode. After this call the array is ready for another
 * frame. Up to two words of the aborted frame may still come: take words up to TLAST before those of the next
 * frame. If `source_stopped`, the next line begins an acquisition. Otherwise the subsystem ignores the rest
 * of the acquisition that the source is delivering. DTOF_BUSY if the hardware stays busy. */
dtof_status dtof_abort(const dtof_device *device, bool source_stopped);

/* Recovers from any fault. Stop the source before this call. Calls dtof_abort, and clears errors, warnings
 * and interrupts. The settings stay. */
dtof_status dtof_recover(const dtof_device *device);

/* Runs the hardware's self-test with the settings and columns that were written last, and commits them. No
 * source and no sink are needed; lines of the source wait meanwhile. `seed` and `expected`, the checksum that
 * the models compute for these settings, are written to the device. The function reads STATUS until the
 * self-test ends, at most `most_reads` times. DTOF_OK if the self-test has passed, DTOF_FAILED if it has
 * failed or, with has_parity, if a word had a wrong parity. DTOF_ARGUMENT for a device without has_self_test.
 * DTOF_BUSY if a frame or the self-test is under way after the last read, or if there is no verdict: the sink
 * has not taken all words, the settings are illegal, or the self-test was aborted. ERROR.SELF_TEST and
 * ERROR.PARITY are cleared before, and stay after a failure. */
dtof_status dtof_self_test(const dtof_device *device, uint32_t seed, uint32_t expected, uint32_t most_reads);

/* Reads the state of the device. */
dtof_status dtof_read_state(const dtof_device *device, dtof_state *state);

/* Whether a frame is under way. */
dtof_status dtof_busy(const dtof_device *device, bool *busy);

/* Reads the number of frames since reset, modulo 2^32, and the clocks of the last frame. */
dtof_status dtof_frames(const dtof_device *device, uint32_t *frames, uint32_t *cycles);

/* Each function reads bits that were set since its last call, and clears them: errors (DTOF_ERROR_*_MASK),
 * warnings about results (DTOF_WARNING_*_MASK), and causes of the interrupt. */
dtof_status dtof_take_errors(const dtof_device *device, uint32_t *errors);
dtof_status dtof_take_warnings(const dtof_device *device, uint32_t *warnings);
dtof_status dtof_take_interrupts(const dtof_device *device, uint32_t *causes);

/* Unpacks a word of the result stream. DTOF_STREAM if its row or column is outside of the array, DTOF_ABORTED
 * if the word marks an aborted frame. For the word of a second target, pass the result that the word before
 * has filled: the function sets only second_position and has_second. DTOF_STREAM if row and column of the two
 * words differ. */
dtof_status dtof_unpack(const dtof_device *device, uint64_t word, dtof_result *result);

/* Unpacks a frame's words. The result of a pixel goes to row * columns + column of `results`, which holds
 * rows x columns. The pixels may have any order; the word of a second target comes directly after the first.
 * DTOF_ABORTED if the frame was aborted. DTOF_STREAM unless each pixel comes once, and all or none have a
 * second target. */
dtof_status dtof_unpack_frame(const dtof_device *device, const uint64_t *words, size_t count,
                              dtof_result *results);

/* Row and column of the pixel with this index in the order of the stream: row by row, or the order of
 * poolPointer's engines. Of a frame with second targets, index / 2 is the index of a word's pixel.
 * DTOF_ARGUMENT if the array has no such pixel. */
dtof_status dtof_pixel_at(const dtof_device *device, size_t index, uint16_t *row, uint16_t *column);

/* Unpacks a word with amplitude and ambient. Row and column of the result, which it does not have, stay as
 * they are. For the word of a second target, pass the result that the word before has filled: DTOF_STREAM if
 * amplitude or ambient of the two words differ. DTOF_STREAM also if the word is no result, DTOF_ABORTED if it
 * marks an aborted frame. */
dtof_status dtof_unpack_amplitude(uint64_t word, dtof_result *result);

/* Unpacks a frame of words with amplitude and ambient as dtof_unpack_frame does. The order of the words gives
 * row and column. DTOF_STREAM unless the frame has a word of each pixel, or two. */
dtof_status dtof_unpack_amplitude_frame(const dtof_device *device, const uint64_t *words, size_t count,
                                        dtof_result *results);

/* Unpacks a short word. Row and column of the result, which it does not have, stay as they are. For the word
 * of a second target, pass the result that the word before has filled. DTOF_STREAM if the word is no result,
 * DTOF_ABORTED if it marks an aborted frame. */
dtof_status dtof_unpack_short(uint32_t word, dtof_result *result);

/* Unpacks a frame of short words as dtof_unpack_frame does. `count` is the number of words of 64 bits. A
 * confidence above 511 is 511. DTOF_STREAM unless the frame has a short word of each pixel, or two. */
dtof_status dtof_unpack_short_frame(const dtof_device *device, const uint64_t *words, size_t count,
                                    dtof_result *results);

/* Unpacks the words of a raw frame: rows first_row to last_row, in the order of the stream (row, bin,
 * column). The bins of a pixel are contiguous in `bins`, at ((row - first_row) * columns + column) * raw_bins
 * + bin. `bins` holds (last_row - first_row + 1) * columns * raw_bins results. DTOF_STREAM if the words do
 * not have this order. */
dtof_status dtof_unpack_raw(const dtof_device *device, uint16_t first_row, uint16_t last_row,
                            const uint64_t *words, size_t count, dtof_result *bins);

/* The CRC-32 of IEEE 802.3 over the words, the lowest byte of each word first, as the hardware computes it
 * for a frame. */
uint32_t dtof_crc(const uint64_t *words, size_t count);

/* Compares the words of the last frame with its checksum. Call it after the frame's last word was taken, and
 * in continuous mode before the next frame ends; DTOF_BUSY if a frame ends during the call. DTOF_CORRUPT if a
 * word was lost, changed or moved, DTOF_ABORTED for the words of an aborted frame. `frame` is the frame's
 * number since reset, modulo 2^32; the first frame has the number 1. */
dtof_status dtof_check_frame(const dtof_device *device, const uint64_t *words, size_t count, uint32_t *frame);

/* Returns the second target as a separate result; has_second must be true. */
dtof_result dtof_second(const dtof_result *result);

/* Distance of a result by a look-up table of `count` points. The table has at least one point, and its
 * positions are strictly ascending. The function interpolates linearly between points, and extrapolates with
 * the slope of the whole table. */
double dtof_distance_mm(const dtof_device *device, const dtof_result *result, const dtof_point *table,
                        size_t count);

/* Distance without a table: half the way of light until the middle of the position's code, minus the sensor's
 * pulse width. A code has `code_ps` picoseconds. */
double dtof_time_of_flight_mm(const dtof_device *device, const dtof_result *result, double code_ps,
                              double fwhm_ps);

#ifdef __cplusplus
}
#endif

#endif
