// Control of write_faults.cpp within a process.
#pragma once

extern "C" {

// Values of `error` besides those of errno: a write is shorter; the process is killed (SIGKILL) before the call; it is
// killed after a half of a write.
constexpr int kShortWrite = 0, kKillBefore = -1, kKillInside = -2;

// From now on the call number `at`, from 1, to files below `folder` fails with this error. `call` limits this to calls
// of one name; "" means any.
void tyndall_write_faults(const char* folder, long at, int error, const char* call);

// Lets the file systems have unnamed files (O_TMPFILE), or not.
void tyndall_unnamed_files(bool available);

// Returns the number of calls since then.
long tyndall_write_calls();
}
