// Server threads: those that use the cores that the display leaves over.
//
// Threads: each for itself.
#pragma once

#include <string>

namespace belvedere {

// Names the calling thread "srv NAME" and has the system prefer the display's threads to it.
void BecomeServerThread(const std::string& name);

}  // namespace belvedere
