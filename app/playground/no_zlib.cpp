// SPDX-License-Identifier: Apache-2.0
// A page has no zlib: its script unpacks gzip files and the variables of MATLAB files (page/files.js). What
// readers call of zlib for packed data refuses here.
#include <zlib.h>

extern "C" {

int inflateInit_(z_streamp /*stream*/, const char* /*version*/, int /*size*/) { return Z_STREAM_ERROR; }
int inflate(z_streamp /*stream*/, int /*flush*/) { return Z_STREAM_ERROR; }
int inflateEnd(z_streamp /*stream*/) { return Z_STREAM_ERROR; }
}
