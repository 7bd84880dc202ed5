// Control of write_faults.cpp within a process.
#pragma once

extern "C" {

// Values of `error` besides those of errno: a write writes less than requested; the process is killed (SIGKILL) before
// the call; the process is killed after half of a write.
constexpr int kShortWrite = 0, kKillBefore = -1, kKillInside = -2;

// Makes one of the following calls for files below `folder` fail with this error: the call number `at`, counted from 1.
// With a name in `call`, only calls of this function are counted; with "", calls of all functions.
void tyndall_write_faults(const char* folder, long at, int error, const char* call);

// Sets whether file systems appear to support unnamed files (O_TMPFILE).
void tyndall_unnamed_files(bool available);

// Returns the number of counted calls since tyndall_write_faults().
long tyndall_write_calls();
}
