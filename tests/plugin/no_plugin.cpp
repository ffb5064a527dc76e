// A shared library that has nothing to do with hilcam.
extern "C" int answer() { return 42; }
