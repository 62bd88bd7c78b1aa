/* A time of day that a test sets while a program runs: ahead of this machine's by the seconds in the file $ADIT_CLOCK_AHEAD, a
   double. Preloaded by test_clock.py. */
#define _GNU_SOURCE
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

static const volatile double *ahead;

__attribute__((constructor)) static void begin(void) {
  const char *const file = getenv("ADIT_CLOCK_AHEAD");
  const int fd = file ? open(file, O_RDONLY | O_CLOEXEC) : -1;
  void *const place = fd < 0 ? MAP_FAILED : mmap(NULL, sizeof *ahead, PROT_READ, MAP_SHARED, fd, 0);
  if (place != MAP_FAILED) ahead = place;
  if (fd >= 0) close(fd);
}

int clock_gettime(clockid_t clock, struct timespec *now) {
  const int done = (int)syscall(SYS_clock_gettime, clock, now);
  if (done == 0 && clock == CLOCK_REALTIME && ahead) now->tv_sec += (time_t)floor(*ahead);
  return done;
}
