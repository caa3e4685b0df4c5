// Only in builds with the address sanitizer: the leak report is made at the end, when graphics drivers are unloaded and
// what they left behind has no name any more that a suppression could know. So nothing is unloaded.
extern "C" int dlclose(void*) { return 0; }
