/// Ctrl-C as a wish that the render loop looks at between passes.
#pragma once

namespace vkpm {

/// From now on the first SIGINT or SIGTERM only sets a flag; a second one kills. Writing past a limit on the size of
/// files becomes an error of write(), not a death.
void catchInterrupts();

/// Whether SIGINT or SIGTERM has come; safe from any thread.
bool interrupted();

} // namespace vkpm
