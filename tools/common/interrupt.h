// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace woodcock::tool {

/// From now on the first SIGINT, SIGTERM or SIGHUP (where it was not ignored) is remembered. A
/// second one ends the program at once with exit code exitInterrupted, unless it is a SIGTERM.
void catchInterrupts();

bool interrupted();

/// From now on SIGUSR1 asks for a checkpoint.
void catchCheckpointRequests();
/// Whether one was asked for since this was asked last.
bool takeCheckpointRequest();

/// Ends the command with exitInterrupted where interrupted().
void endIfInterrupted();

}  // namespace woodcock::tool
