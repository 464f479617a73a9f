// What the leak sanitizer is to pass over; without that sanitizer nobody calls this function.

// HDF5 never frees what belongs to a file that it could not complete, as in the tests of a full disk.
// NOLINTNEXTLINE(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }
