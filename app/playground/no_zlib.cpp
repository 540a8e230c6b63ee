// SPDX-License-Identifier: Apache-2.0
// A page has no zlib: its script unpacks gzip files and the variables of MATLAB files (page/files.js). What
// readers call of zlib for a file or for packed data refuses here.
#include <zlib.h>

extern "C" {

gzFile gzopen(const char* /*path*/, const char* /*mode*/) { return nullptr; }
int gzbuffer(gzFile /*file*/, unsigned /*size*/) { return -1; }
int gzread(gzFile /*file*/, voidp /*buffer*/, unsigned /*length*/) { return -1; }
const char* gzerror(gzFile /*file*/, int* code) {
  *code = Z_STREAM_ERROR;
  return "";
}
int gzclose_r(gzFile /*file*/) { return Z_STREAM_ERROR; }
int inflateInit_(z_streamp /*stream*/, const char* /*version*/, int /*size*/) { return Z_STREAM_ERROR; }
int inflate(z_streamp /*stream*/, int /*flush*/) { return Z_STREAM_ERROR; }
int inflateEnd(z_streamp /*stream*/) { return Z_STREAM_ERROR; }
}
