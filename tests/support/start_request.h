// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>
#include <sys/types.h>

#include <array>
#include <cstring>

namespace woodcock::test {

// What a test and a program that starts again (tests/programs/start_again.cpp) tell each other.

/// Names the socket of requests, in the environment.
constexpr const char* startAgainVariable = "WOODCOCK_START_AGAIN";

/// What a request brings: a file of strings that end with '\0' (the folder, the number of
/// arguments, the arguments, the environment), stdout, stderr, and where the end is told.
enum { startRequest, startOut, startErr, startEnd };
using StartDescriptors = std::array<int, 4>;

/// Told twice: when the process is there, and when it has ended.
struct StartEnd {
    pid_t process;
    int status;        ///< as of wait()
    long residentKiB;  ///< the most memory that it held at once
};

/// A message of one byte and the descriptors.
struct StartMessage {
    char byte = 0;
    iovec data{&byte, 1};
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(StartDescriptors))] = {};
    msghdr header{nullptr, 0, &data, 1, control, sizeof control, 0};
};

inline bool send(int socket, const StartDescriptors& descriptors) {
    StartMessage message;
    cmsghdr* control = CMSG_FIRSTHDR(&message.header);
    control->cmsg_level = SOL_SOCKET;
    control->cmsg_type = SCM_RIGHTS;
    control->cmsg_len = CMSG_LEN(sizeof descriptors);
    std::memcpy(CMSG_DATA(control), descriptors.data(), sizeof descriptors);
    return sendmsg(socket, &message.header, MSG_NOSIGNAL) == 1;
}

/// Waits for the next; false where none will come.
inline bool receive(int socket, StartDescriptors& descriptors) {
    StartMessage message;
    if (recvmsg(socket, &message.header, MSG_CMSG_CLOEXEC) != 1) return false;
    const cmsghdr* control = CMSG_FIRSTHDR(&message.header);
    if (!control) return false;
    std::memcpy(descriptors.data(), CMSG_DATA(control), sizeof descriptors);
    return true;
}

}  // namespace woodcock::test
