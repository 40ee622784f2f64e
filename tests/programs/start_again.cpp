// SPDX-License-Identifier: Apache-2.0
// Loaded into a program (LD_PRELOAD), it stops it just before main() and starts it again and again
// from there, each time in a process of its own. Loading and linking the libraries is most of what
// a start takes, and is done once. tests/support/program_starter.cpp asks for the starts.
#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "tests/support/start_request.h"

namespace {

using namespace woodcock::test;

using Main = int (*)(int, char**, char**);
using Hook = void (*)();

Main programMain = nullptr;

struct Request {
    std::vector<std::string> strings;
    std::vector<char*> arguments, environment;  ///< both end with a null
};

Request& readRequest(int file) {
    static Request request;  // lives as long as the program does
    std::string text(static_cast<std::size_t>(lseek(file, 0, SEEK_END)), '\0');
    if (pread(file, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size())) _exit(127);
    for (std::size_t at = 0; at < text.size(); at += request.strings.back().size() + 1)
        request.strings.emplace_back(text.c_str() + at);
    // The folder, the number of arguments, these, and the environment.
    const std::size_t count = std::stoul(request.strings.at(1));
    for (std::size_t i = 2; i < request.strings.size(); ++i)
        (i < 2 + count ? request.arguments : request.environment)
            .push_back(request.strings[i].data());
    request.arguments.push_back(nullptr);
    request.environment.push_back(nullptr);
    return request;
}

/// In the program's process: becomes what a start by exec() would have made.
[[noreturn]] void runMain(const StartDescriptors& descriptors) {
    Request& request = readRequest(descriptors[startRequest]);
    if (chdir(request.strings.front().c_str()) != 0) _exit(127);
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(descriptors[startOut], STDOUT_FILENO);
    dup2(descriptors[startErr], STDERR_FILENO);
    closefrom(STDERR_FILENO + 1);
    environ = request.environment.data();
    exit(programMain(static_cast<int>(request.arguments.size()) - 1, request.arguments.data(),
                     environ));
}

/// Stays the parent of one start, and tells of its end.
[[noreturn]] void keep(const StartDescriptors& descriptors) {
    signal(SIGCHLD, SIG_DFL);
    const pid_t process = fork();
    if (process == 0) runMain(descriptors);
    const int tell = descriptors[startEnd];
    close(descriptors[startErr]);  // whose reader waits for its end
    StartEnd end{process, 0, 0};
    if (write(tell, &end, sizeof end) != sizeof end) _exit(1);
    rusage used{};
    wait4(process, &end.status, 0, &used);
    end.residentKiB = used.ru_maxrss;
    _exit(write(tell, &end, sizeof end) == sizeof end ? 0 : 1);
}

int startAgain(int, char**, char**) {
    const int requests = std::atoi(getenv(startAgainVariable));
    signal(SIGCHLD, SIG_IGN);  // nothing waits for those that keep
    for (;;) {
        StartDescriptors descriptors;
        if (!receive(requests, descriptors)) _exit(0);
        if (fork() == 0) keep(descriptors);
        for (const int descriptor : descriptors) close(descriptor);
    }
}

}  // namespace

/// Without the destructors of libraries: log4cplus, which OpenVDB brings, would wait for threads
/// that it began when it was loaded, and that stayed in the first process.
extern "C" __attribute__((visibility("default"))) void exit(int code) {
    std::fflush(nullptr);
    _exit(code);
}

/// What calls main(), once all libraries and the program have set themselves up.
extern "C" __attribute__((visibility("default"))) int __libc_start_main(Main main, int argc,
                                                                        char** argv, Hook init,
                                                                        Hook fini, Hook rtldFini,
                                                                        void* stackEnd) {
    using Start = int (*)(Main, int, char**, Hook, Hook, Hook, void*);
    const auto start = reinterpret_cast<Start>(dlsym(RTLD_NEXT, "__libc_start_main"));
    programMain = main;
    return start(getenv(startAgainVariable) ? startAgain : main, argc, argv, init, fini, rtldFini,
                 stackEnd);
}
