// Linked into every program of a build with sanitizers. LLVM's OpenMP library forgets what it has
// allocated for its threads (1440 bytes each), and the leak checker would blame the program. A leak
// of the program's own within a parallel region passes for the library's with it; the build with
// GCC, whose library is another one, still tells it.
extern "C" const char* __lsan_default_suppressions() { return "leak:libomp.so\n"; }
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }
