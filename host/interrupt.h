/// Ctrl-C and its kin as a wish that the render loop looks at between passes.
#pragma once

namespace vkpm {

/// From now on SIGINT, SIGTERM, SIGHUP and SIGXCPU (no processor time is left) end the program with code 130 and a
/// message, at once as long as there is nothing to save; once there is, the first one only sets a flag, and a second
/// SIGINT or SIGTERM kills. SIGHUP stays ignored if it was (nohup). Writing to a pipe whose reader is gone, or past a
/// limit on the size of files, becomes an error of write(), not a death.
void catchInterrupts();

/// What an interrupt says, a text that lives as long as the program, without "vkpm: ". With `ends` it ends the program.
void onInterrupt(const char* text, bool ends);

/// Whether one of the signals has come after onInterrupt(..., false); safe from any thread.
bool interrupted();

} // namespace vkpm
