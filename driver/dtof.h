/* SPDX-License-Identifier: Apache-2.0
 * Driver of dtof_subsystem (docs/user/integration.md): finds it, sets it up, starts frames, reads its result
 * stream and turns positions into millimetres. C99, no dependencies, no memory of its own; a device is a
 * structure of the caller's.
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

/* What a function returns: 0, or what is wrong. */
typedef enum {
  DTOF_OK = 0,
  DTOF_BUS = -1,             /* an access of the bus failed */
  DTOF_NOT_FOUND = -2,       /* ID is another one */
  DTOF_VERSION_UNKNOWN = -3, /* another major version, or a minor version without registers that are needed */
  DTOF_ARGUMENT = -4,        /* a value that the hardware cannot take */
  DTOF_BUSY = -5,            /* a frame is under way */
  DTOF_STREAM = -6,          /* a result's row or column is not the array's */
  DTOF_ABORTED = -7,         /* the frame was aborted: its words end here */
  DTOF_CORRUPT = -8          /* the words are not those that were sent */
} dtof_status;

/* How registers are reached. Both return false if the access failed; `offset` is in bytes. */
typedef struct {
  void *context;
  bool (*read)(void *context, uint32_t offset, uint32_t *value);
  bool (*write)(void *context, uint32_t offset, uint32_t value);
} dtof_bus;

/* What the hardware is, as its registers say. */
typedef struct {
  dtof_bus bus;
  uint16_t columns;
  uint16_t rows;
  uint8_t slots;
  uint8_t readout; /* the parameter READOUT */
  uint8_t timestamp_bits;
  uint8_t fraction_bits;   /* of a position */
  uint8_t confidence_bits; /* 0: the read-out has none */
  uint8_t acquisition_bits;
  bool has_schedule; /* poolPointer */
  bool has_gate;
  bool has_raster_order; /* results come row by row */
  bool has_second_target;
  bool has_prior;
  bool has_raw_histogram;
  bool has_parity;   /* of the words in the subsystem's own memories */
  bool clock_waits;  /* the array waits for a line that is late inside an acquisition */
  bool source_waits; /* false: acquisitions for which there is no room are dropped */
  uint32_t raw_bins; /* of a raw histogram; 0 where there is none */
  uint16_t acquisition_lines;
  uint16_t buffer_lines;
  /* The parameters of these names; those that the read-out does not use have no meaning. */
  uint8_t count_width;
  uint8_t nb;
  bool window_centred;
  uint16_t pointer_step;
  uint32_t guard;
  /* Those of poolPointer, by which lean is another product; 0 where has_schedule is false. */
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

/* What a frame uses. */
typedef struct {
  uint32_t acquisitions;
  uint8_t coarse_share; /* poolPointer: 64ths of the frame for the coarse and the track phase, at most 64
                           together */
  uint8_t track_share;
  uint16_t gate_begin; /* a timestamp from begin to below end counts; ignored where there is no gate */
  uint16_t gate_end;
  uint16_t weak_below; /* a confidence below is weak */
  bool second_target;  /* each pixel's second target, too; DTOF_ARGUMENT where has_second_target is false */
  bool smooth;         /* poolPointer: neighbours on one surface are drawn together; ignored elsewhere */
  bool prior;          /* candidates begin from the last frame's; DTOF_ARGUMENT where has_prior is false */
  bool raw; /* histograms of these rows instead of results; DTOF_ARGUMENT without has_raw_histogram */
  uint16_t raw_first_row;
  uint16_t raw_last_row;
  uint16_t release; /* clock_waits: lines of an acquisition that come before the shot of the next; else: lines
                       in the buffer before an acquisition begins; 0: as many as possible */
  uint8_t shot_bits; /* start dither: shot_o waits 0 to 2^shot_bits - 1 units, at most 7; 0: no wait */
  uint8_t shot_unit; /* clocks of a unit */
  uint16_t settle; /* acquisitions at the frame's start that are dropped, before the first one that counts */
} dtof_settings;

/* What goes on, and what went wrong; nothing is forgotten by reading. */
typedef struct {
  bool busy;           /* a frame is under way */
  uint8_t array_state; /* state_o of the array */
  uint16_t level;      /* lines in the line buffer */
  uint32_t errors;     /* DTOF_ERROR_*_MASK */
  uint32_t warnings;   /* DTOF_WARNING_*_MASK */
  uint32_t frames;     /* since reset, modulo 2^32 */
  uint32_t lost_lines; /* these two since reset, at most 2^32 - 1 */
  uint32_t lost_acquisitions;
  uint32_t parity_errors; /* likewise; 0 where has_parity is false */
} dtof_state;

/* One pixel's result. */
typedef struct {
  uint16_t row;
  uint16_t column;
  uint16_t position; /* code and below it the fraction: units of 2^-fraction_bits code */
  uint16_t confidence;
  bool valid; /* none of the three below */
  bool weak;
  bool empty;     /* confidence 0 */
  bool masked;    /* the column is not enabled */
  bool saturated; /* the confidence has its largest value: more may have been seen */
  bool raw;       /* a bin of a raw histogram: its lowest code and, as the confidence, its count */
  bool has_second;
  uint16_t second_position; /* where has_second: of the pixel's second target */
} dtof_result;

/* A point of a look-up table: the distance at a position in codes. */
typedef struct {
  double position;
  double distance_mm;
} dtof_point;

/* Finds the subsystem and reads what it is. */
dtof_status dtof_probe(dtof_device *device, dtof_bus bus);

/* What suits the device, whatever the number of acquisitions: everything counts, poolPointer smooths, and
 * its shares of the frame are those that the device recommends. */
dtof_settings dtof_default_settings(const dtof_device *device, uint32_t acquisitions);

/* Writes the settings of the frames that begin behind dtof_commit or dtof_start. DTOF_ARGUMENT, with nothing
 * written, for what the hardware cannot take. */
dtof_status dtof_configure(const dtof_device *device, const dtof_settings *settings);

/* Enables the columns whose bit in `mask` is set, column 0 lowest, 32 a word; (columns + 31) / 32 words. A
 * setting like those of dtof_configure. */
dtof_status dtof_enable_columns(const dtof_device *device, const uint32_t *mask);

#define DTOF_TEMPLATE_ENTRIES 32

/* poolPointer: what decode takes from each coarse bin, where cover glass and fog send light back; all 0
 * behind a reset. At once: between frames alone, or the bus refuses it and nothing changes. DTOF_ARGUMENT for
 * a device without has_schedule. docs/reference/poolpointer.md, Template, says what the entries are. */
dtof_status dtof_set_template(const dtof_device *device, const uint8_t entries[DTOF_TEMPLATE_ENTRIES]);

/* Makes all settings that were written valid together, for every frame that begins from now on; for
 * continuous mode. */
dtof_status dtof_commit(const dtof_device *device);

/* Begins the sequence of start dither's delays at `seed`, at once; 1 to 65535, another one in each sensor, or
 * their delays are the same. DTOF_ARGUMENT for others. */
dtof_status dtof_seed_shots(const dtof_device *device, uint32_t seed);

/* A seed for the sensor with this serial number: neighbouring numbers give seeds that are far apart. */
uint32_t dtof_shot_seed(uint32_t serial_number);

/* From which state the delays of the frame follow that began last: the seed of the same sequence in the
 * models. */
dtof_status dtof_read_shot_state(const dtof_device *device, uint32_t *state);

/* How many clocks a frame waits for a line before the rest of it counts as no detection, at once; 0: for
 * ever. DTOF_ARGUMENT above 2^24 - 1, which is the value at reset. */
dtof_status dtof_set_watchdog(const dtof_device *device, uint32_t clocks);

/* Raises the interrupt when a frame's results were taken, when something went wrong, both or neither. */
dtof_status dtof_enable_interrupts(const dtof_device *device, bool frame, bool error);

/* Begins a frame, or frames that follow each other. DTOF_BUSY while one is under way. */
dtof_status dtof_start(const dtof_device *device, bool continuous);

/* Ends continuous mode; the frame that is under way is the last. */
dtof_status dtof_stop(const dtof_device *device);

/* Empties the line buffer. DTOF_BUSY while a frame is under way. */
dtof_status dtof_flush(const dtof_device *device);

/* Ends the frame that is under way, whatever it waits for, and continuous mode; the array is ready for
 * another one behind this call. `source_stopped`: the next line that comes begins an acquisition; otherwise
 * the rest of the acquisition that the source is in is thrown away. DTOF_BUSY if the hardware does not obey.
 */
dtof_status dtof_abort(const dtof_device *device, bool source_stopped);

/* Behind any fault, with the source stopped: dtof_abort, and errors, warnings and interrupts are forgotten.
 * The settings stay. */
dtof_status dtof_recover(const dtof_device *device);

/* What goes on. */
dtof_status dtof_read_state(const dtof_device *device, dtof_state *state);

/* Whether a frame is under way. */
dtof_status dtof_busy(const dtof_device *device, bool *busy);

/* Frames since reset, modulo 2^32, and clocks of the last one. */
dtof_status dtof_frames(const dtof_device *device, uint32_t *frames, uint32_t *cycles);

/* DTOF_ERROR_*_MASK of what went wrong since the last call, and forgets it; likewise DTOF_WARNING_*_MASK of
 * what the results should be read with, and the interrupt's causes. */
dtof_status dtof_take_errors(const dtof_device *device, uint32_t *errors);
dtof_status dtof_take_warnings(const dtof_device *device, uint32_t *warnings);
dtof_status dtof_take_interrupts(const dtof_device *device, uint32_t *causes);

/* A word of the result stream. DTOF_STREAM if its place is not one of the array's, DTOF_ABORTED if it says
 * that the frame ended before its last result. That of a second target sets only second_position and
 * has_second and asks for the result that the word before filled: DTOF_STREAM if its row and column are
 * others. */
dtof_status dtof_unpack(const dtof_device *device, uint64_t word, dtof_result *result);

/* A frame's words, placed at row * columns + column of `results`, which holds rows x columns; pixels in any
 * order, a second target directly behind its first. DTOF_ABORTED if the frame was aborted; DTOF_STREAM if
 * they are not each pixel once, with a second target for all or none. */
dtof_status dtof_unpack_frame(const dtof_device *device, const uint64_t *words, size_t count,
                              dtof_result *results);

/* The words of a raw frame in the order of the stream: rows first_row to last_row, bins, columns. A pixel's
 * bins are placed one behind the other, pixel by pixel of a row, at ((row - first_row) * columns + column) *
 * raw_bins + bin of `bins`, which holds (last_row - first_row + 1) * columns * raw_bins. DTOF_STREAM if they
 * are not that. */
dtof_status dtof_unpack_raw(const dtof_device *device, uint16_t first_row, uint16_t last_row,
                            const uint64_t *words, size_t count, dtof_result *bins);

/* CRC-32 of IEEE 802.3 over the words, the lowest byte of each first: what the hardware computes of a frame.
 */
uint32_t dtof_crc(const uint64_t *words, size_t count);

/* Compares the words of the frame that ended last with its checksum, once its last word was taken:
 * DTOF_CORRUPT if a word was lost, changed or moved, DTOF_ABORTED for the words of a frame that was aborted.
 * `frame` is its number since reset, 1 the first, modulo 2^32. In continuous mode call it before the next
 * frame ends; DTOF_BUSY if one ends meanwhile. */
dtof_status dtof_check_frame(const dtof_device *device, const uint64_t *words, size_t count, uint32_t *frame);

/* The second target as a result of its own; has_second must be true. */
dtof_result dtof_second(const dtof_result *result);

/* Distance of a result by a table of `count` points, at least one, positions strictly ascending: linear
 * between points, and beyond both ends along the line of the whole table's slope. */
double dtof_distance_mm(const dtof_device *device, const dtof_result *result, const dtof_point *table,
                        size_t count);

/* Distance without a table: half the way of light until the middle of the position's code, codes of `code_ps`
 * picoseconds, less the sensor's pulse width. */
double dtof_time_of_flight_mm(const dtof_device *device, const dtof_result *result, double code_ps,
                              double fwhm_ps);

#ifdef __cplusplus
}
#endif

#endif
