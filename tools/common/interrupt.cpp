// SPDX-License-Identifier: Apache-2.0
#include "tools/common/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>

#include "tools/common/exit_codes.h"

namespace woodcock::tool {

namespace {

std::atomic<bool> requested = false, checkpointRequested = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch nothing else");

// Farms send SIGTERM to all processes of a task, and again: it means the same each time.
extern "C" void onInterrupt(int signal) {
    if (requested.exchange(true) && signal != SIGTERM) _exit(exitInterrupted);
}

extern "C" void onCheckpointRequest(int) { checkpointRequested = true; }

}  // namespace

void catchCheckpointRequests() {
    struct sigaction action {};
    action.sa_handler = onCheckpointRequest;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    sigaction(SIGUSR1, &action, nullptr);
}

bool takeCheckpointRequest() { return checkpointRequested.exchange(false); }

void catchInterrupts() {
    struct sigaction action {};
    action.sa_handler = onInterrupt;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    // Under nohup a closed terminal is no reason to stop.
    struct sigaction before {};
    if (sigaction(SIGHUP, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)
        sigaction(SIGHUP, &action, nullptr);
}

bool interrupted() { return requested; }

void endIfInterrupted() {
    if (interrupted()) endWith(exitInterrupted);
}

}  // namespace woodcock::tool
