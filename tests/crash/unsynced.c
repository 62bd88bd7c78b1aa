#define _GNU_SOURCE
#include "unsynced.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

enum { SECTOR = 512 };

/* One change. Beyond `old_size` there was nothing before. */
struct Change {
  struct Change* earlier;
  dev_t device;
  ino_t inode;
  int file;
  off_t offset;
  size_t size;    /* bytes changed */
  size_t kept;    /* of these, how many were there before: they are in `before` */
  off_t old_size; /* of the file */
  char before[];
};

static struct Change* latest;

/* The plain system calls: the library's own are fault points. */
static ssize_t read_at(int file, void* data, size_t size, off_t offset) {
  return syscall(SYS_pread64, file, data, size, offset);
}
static void write_at(int file, const void* data, size_t size, off_t offset) {
  if (size > 0 && syscall(SYS_pwrite64, file, data, size, offset) != (ssize_t)size) abort();
}
static void set_size(int file, off_t size) {
  if (syscall(SYS_ftruncate, file, size) != 0) abort();
}

static void remember(int file, off_t offset, size_t size) {
  struct stat status;
  if (fstat(file, &status) != 0) abort();
  const off_t end = offset + (off_t)size < status.st_size ? offset + (off_t)size : status.st_size;
  const size_t kept = end > offset ? (size_t)(end - offset) : 0;
  struct Change* change = malloc(sizeof *change + kept);
  if (change == NULL || read_at(file, change->before, kept, offset) != (ssize_t)kept) abort();
  change->earlier = latest;
  change->device = status.st_dev;
  change->inode = status.st_ino;
  change->file = file;
  change->offset = offset;
  change->size = size;
  change->kept = kept;
  change->old_size = status.st_size;
  latest = change;
}

void remember_write(int file, off_t offset, size_t size) {
  remember(file, offset, size);
}

void remember_truncation(int file, off_t length) {
  struct stat status;
  if (fstat(file, &status) != 0) abort();
  remember(file, length, status.st_size > length ? (size_t)(status.st_size - length) : 0);
}

static bool is_of(const struct Change* change, const struct stat* file) {
  return change->device == file->st_dev && change->inode == file->st_ino;
}

/* Takes the changes of one file out of the list, the latest first. */
static struct Change* changes_of(const struct stat* file) {
  struct Change *found = NULL, **end = &found, **at = &latest;
  while (*at != NULL) {
    struct Change* change = *at;
    if (!is_of(change, file)) {
      at = &change->earlier;
      continue;
    }
    *at = change->earlier;
    change->earlier = NULL;
    *end = change;
    end = &change->earlier;
  }
  return found;
}

void forget_changes(int file) {
  struct stat status;
  if (fstat(file, &status) != 0) abort();
  for (struct Change *change = changes_of(&status), *earlier; change != NULL; change = earlier) {
    earlier = change->earlier;
    free(change);
  }
}

static void take_back(const struct Change* change) {
  write_at(change->file, change->before, change->kept, change->offset);
  set_size(change->file, change->old_size);
}

/* splitmix64: each number, well stirred. */
static uint64_t stirred(uint64_t number) {
  number += 0x9e3779b97f4a7c15u;
  number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9u;
  number = (number ^ (number >> 27)) * 0x94d049bb133111ebu;
  return number ^ (number >> 31);
}

/* Takes back the part of a change that lies in sectors that were lost; what had been nothing becomes zeros.
 */
static void take_back_sectors(const struct Change* change, uint64_t chance) {
  static const char zeros[SECTOR];
  const off_t end = change->offset + (off_t)change->size;
  for (off_t at = change->offset; at < end;) {
    const off_t next = at / SECTOR * SECTOR + SECTOR < end ? at / SECTOR * SECTOR + SECTOR : end;
    const bool lost = (stirred(chance + (uint64_t)(at / SECTOR)) & 1) != 0;
    const off_t known_end = change->offset + (off_t)change->kept;
    const off_t known = next < known_end ? next : known_end;
    if (lost && known > at)
      write_at(change->file, change->before + (at - change->offset), (size_t)(known - at), at);
    const off_t new_from = at > known_end ? at : known_end;
    if (lost && next > new_from) write_at(change->file, zeros, (size_t)(next - new_from), new_from);
    at = next;
  }
}

/* Of `count` changes, the latest first, some are lost. Says how. */
static void tear_file(struct Change* change, unsigned count, uint64_t chance, void (*say)(const char* line)) {
  char line[160];
  const uint64_t way = chance % 3;
  const unsigned lost = way == 0 ? count : 1 + (unsigned)(chance / 3 % count);
  if (way < 2) {
    for (unsigned i = 0; i < lost; ++i, change = change->earlier) take_back(change);
    snprintf(line, sizeof line, "torn: the last %u of %u changes", lost, count);
    say(line);
    return;
  }
  const int file = change->file;
  off_t first_size = 0;
  for (; change != NULL; change = change->earlier) {
    take_back_sectors(change, chance);
    first_size = change->old_size;
  }
  const bool size_lost = (stirred(chance) & 1) != 0;
  if (size_lost) set_size(file, first_size);
  snprintf(line, sizeof line, "torn: sectors of %u changes%s", count, size_lost ? ", and the size" : "");
  say(line);
}

void tear(unsigned seed, void (*say)(const char* line)) {
  uint64_t chance = stirred(seed);
  while (latest != NULL) {
    struct stat status;
    /* Closed, or another file by now: what it was cannot be reached, and a test would prove less. */
    if (fstat(latest->file, &status) != 0 || !is_of(latest, &status)) abort();
    struct Change* changes = changes_of(&status);
    unsigned count = 0;
    for (const struct Change* change = changes; change != NULL; change = change->earlier) ++count;
    tear_file(changes, count, chance, say);
    chance = stirred(chance);
  }
}
