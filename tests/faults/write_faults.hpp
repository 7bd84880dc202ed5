// Control of write_faults.cpp within a process.
#pragma once

extern "C" {

// From now on the call number `at`, from 1, to files below `folder` fails with this errno; 0 as errno makes a write
// shorter instead. `call` limits this to calls of one name; "" means any.
void tyndall_write_faults(const char* folder, long at, int error, const char* call);

// Returns the number of calls since then.
long tyndall_write_calls();
}
