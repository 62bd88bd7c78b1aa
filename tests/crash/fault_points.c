/* Told by the environment:

     FAULT_FOLDER   folder of the ledger
     FAULT_SCORING  port of the scoring endpoint
     FAULT_TEAM     port that aditd listens on
     FAULT_TRACE    file that gets a line for each point
     FAULT_FROM     "start", or "report": points count from the first report that a client posts
     FAULT_KILL     number of the point to be killed at; 0 or nothing: none
     FAULT_WHEN     "before" or "after" the call
     FAULT_TEAR     a number: unsynced changes are lost as chance wills that starts from it; nothing: none is
 */
#define _GNU_SOURCE
#include "fault_points.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <netinet/in.h>
#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "unsynced.h"

static struct {
  const char* folder;
  int scoring, team, trace;
  long kill;
  bool after, tear;
  unsigned seed;
} plan;

static pthread_mutex_t one_at_a_time = PTHREAD_MUTEX_INITIALIZER;
static bool counting;
static long points;

static long number_of(const char* name) {
  const char* text = getenv(name);
  return text != NULL ? strtol(text, NULL, 10) : 0;
}

__attribute__((constructor)) static void read_plan(void) {
  const char *trace = getenv("FAULT_TRACE"), *from = getenv("FAULT_FROM"), *when = getenv("FAULT_WHEN");
  plan.folder = getenv("FAULT_FOLDER");
  plan.trace = trace != NULL ? open(trace, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600) : -1;
  if (plan.folder == NULL || plan.trace < 0) abort();
  plan.scoring = (int)number_of("FAULT_SCORING");
  plan.team = (int)number_of("FAULT_TEAM");
  plan.kill = number_of("FAULT_KILL");
  plan.after = when != NULL && strcmp(when, "after") == 0;
  plan.tear = getenv("FAULT_TEAR") != NULL;
  plan.seed = (unsigned)number_of("FAULT_TEAR");
  counting = from != NULL && strcmp(from, "start") == 0;
}

static void say(const char* line) {
  char whole[PATH_MAX];
  const int length = snprintf(whole, sizeof whole, "%ld %s\n", points, line);
  if (syscall(SYS_write, plan.trace, whole, (size_t)length) != length) abort();
}

static void die(const char* when) {
  char line[64];
  snprintf(line, sizeof line, "killed %s", when);
  say(line);
  if (plan.tear) tear(plan.seed, say);
  syscall(SYS_kill, getpid(), SIGKILL);
  while (true) pause();
}

static bool is_ledger(const char* path) {
  const size_t length = strlen(plan.folder);
  return strncmp(path, plan.folder, length) == 0 && strncmp(path + length, "/ledger.sqlite", 14) == 0;
}

static void name_of_file(int file, char* name) {
  char link[32], path[PATH_MAX];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  if (length <= 0) return;
  path[length] = '\0';
  if (is_ledger(path)) snprintf(name, NAME_MAX + 1, "%s", strrchr(path, '/') + 1);
}

static int port_of(const struct sockaddr_storage* address) {
  return address->ss_family == AF_INET ? ntohs(((const struct sockaddr_in*)address)->sin_port) : 0;
}

static void name_of_socket(int file, char* name) {
  struct sockaddr_storage here = {0}, there = {0};
  socklen_t here_size = sizeof here, there_size = sizeof there;
  if (getsockname(file, (struct sockaddr*)&here, &here_size) != 0) return;
  if (getpeername(file, (struct sockaddr*)&there, &there_size) != 0) return;
  if (port_of(&there) == plan.scoring) strcpy(name, "scoring");
  if (port_of(&here) == plan.team) strcpy(name, "team");
}

/* Points count from the first report that a client posts; the call that receives it is the first. */
static void watch_for_report(int file) {
  static const char wanted[] = "POST /api/artifact_reports";
  char head[sizeof wanted - 1];
  const long seen = syscall(SYS_recvfrom, file, head, sizeof head, MSG_PEEK | MSG_DONTWAIT, NULL, NULL);
  if (seen == (long)sizeof head && memcmp(head, wanted, sizeof head) == 0) counting = true;
}

static void count(struct Point* point, const char* place, long long size, long long offset) {
  point->number = ++points;
  char line[PATH_MAX];
  snprintf(line, sizeof line, "%s %s %lld@%lld", point->call, place, size, offset);
  say(line);
  if (points == plan.kill && !plan.after) die("before");
}

bool begin(struct Point* point, const char* call, int file, long long size, long long offset) {
  const int kept = errno;
  struct stat status;
  char place[NAME_MAX + 1] = "";
  *point = (struct Point){call, 0, false};
  if (fstat(file, &status) == 0) {
    point->is_file = S_ISREG(status.st_mode);
    if (S_ISREG(status.st_mode)) name_of_file(file, place);
    if (S_ISSOCK(status.st_mode)) name_of_socket(file, place);
  }
  errno = kept;
  if (place[0] == '\0') return false;
  pthread_mutex_lock(&one_at_a_time);
  const bool receives = strncmp(call, "re", 2) == 0;
  if (!counting && receives && strcmp(place, "team") == 0) watch_for_report(file);
  if (counting) count(point, place, size, offset);
  errno = kept;
  return true;
}

bool begin_path(struct Point* point, const char* call, const char* path) {
  *point = (struct Point){call, 0, false};
  if (!is_ledger(path)) return false;
  pthread_mutex_lock(&one_at_a_time);
  if (counting) count(point, strrchr(path, '/') + 1, 0, 0);
  return true;
}

ssize_t end(const struct Point* point, ssize_t result) {
  const int kept = errno;
  if (point->number != 0 && point->number == plan.kill && plan.after) die("after");
  pthread_mutex_unlock(&one_at_a_time);
  errno = kept;
  return result;
}
