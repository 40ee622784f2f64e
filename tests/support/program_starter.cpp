// SPDX-License-Identifier: Apache-2.0
#include "tests/support/program_starter.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>

#include "tests/support/paths.h"
#include "tests/support/start_request.h"

namespace woodcock::test {

namespace {

/// The socket of a program that stands before its main(). It ends when this process does.
int openStarter() {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
        throw std::runtime_error("no socket");
    const std::string name = program().string();
    if (fork() == 0) {
        fcntl(ends[1], F_SETFD, 0);
        setenv("LD_PRELOAD", WOODCOCK_START_AGAIN_LIBRARY, 1);
        setenv(startAgainVariable, std::to_string(ends[1]).c_str(), 1);
        execl(name.c_str(), name.c_str(), nullptr);
        _exit(127);
    }
    close(ends[1]);
    return ends[0];
}

int writeRequest(const std::vector<std::string>& arguments) {
    std::string text = std::filesystem::current_path().string() + '\0';
    text += std::to_string(arguments.size() + 1) + '\0' + program().string() + '\0';
    for (const std::string& argument : arguments) text += argument + '\0';
    for (char** variable = environ; *variable; ++variable) text += std::string(*variable) + '\0';
    const int file = memfd_create("start", MFD_CLOEXEC);
    if (write(file, text.data(), text.size()) != static_cast<ssize_t>(text.size()))
        throw std::runtime_error("cannot write a request");
    return file;
}

}  // namespace

bool canStartAgain() { return *WOODCOCK_START_AGAIN_LIBRARY != '\0'; }

StartedProgram startAgain(const std::vector<std::string>& arguments, int out, int err) {
    static const int starter = openStarter();
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    const int request = writeRequest(arguments);
    const bool sent = send(starter, {request, out, err, ends[1]});
    close(request);
    close(ends[1]);
    StartEnd begun{};
    if (!sent || read(ends[0], &begun, sizeof begun) != sizeof begun)
        throw std::runtime_error("the program does not start");
    return {begun.process, ends[0]};
}

}  // namespace woodcock::test
