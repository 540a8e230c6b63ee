// SPDX-License-Identifier: Apache-2.0
// What dtof_pixel_distance says about a timestamp and a pixel's word. All are 0 without a timestamp.
//
// A module includes this file in its body; dtof_pool_command.svh says why.

typedef struct packed {
  logic       offset_up;
  logic       offset_down;
  logic       reach;
  logic       up;
  logic [2:0] weight;
  logic [3:0] gear;
  logic       hit;
  logic       rival_hit;
  logic       rival_up;
  logic       rival_down;
} pixel_distance_t;
