/* Preloaded into aditd: kills it just before or just after one of the calls by which a report's life touches
   the ledger's files, the Command Post's scoring endpoint or a client. */
#ifndef ADIT_TESTS_CRASH_FAULT_POINTS_H
#define ADIT_TESTS_CRASH_FAULT_POINTS_H

#include <stdbool.h>
#include <sys/types.h>

struct Point {
  const char* call;
  long number; /* 0: it does not count yet */
  bool is_file;
};

/* False: the call touches none of these. Else end() has to follow, with what the call gave; nothing else of
   the process comes between. `size` and `offset` are for the trace alone. */
bool begin(struct Point* point, const char* call, int file, long long size, long long offset);
bool begin_path(struct Point* point, const char* call, const char* path);
ssize_t end(const struct Point* point, ssize_t result);

#endif
