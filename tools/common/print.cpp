// SPDX-License-Identifier: Apache-2.0
#include "tools/common/print.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <iostream>
#include <system_error>

#include "woodcock/base/error.h"
#include "woodcock/base/printable.h"

namespace woodcock::tool {

namespace {

int stdoutError = 0;  ///< errno of the first thing that went wrong

void remember(bool written) {
    if (!written && stdoutError == 0) stdoutError = errno ? errno : EIO;
}

}  // namespace

void printText(std::string_view text) { printData(printableLines(text)); }

void printData(std::string_view text) {
    errno = 0;
    remember(std::fwrite(text.data(), 1, text.size(), stdout) == text.size());
}

void printProgressText(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

void holdStandardStreams() {
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        // stdout is held by what cannot be written: what is printed must not count as written.
        if (::fcntl(descriptor, F_GETFD) < 0)
            ::open("/dev/null", descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY);
}

void finishStdout() {
    errno = 0;
    std::cout.flush();  // which goes to stdout as well
    remember(std::fflush(stdout) == 0 && !std::ferror(stdout) && std::cout.good());
    if (stdoutError)
        throw failure("cannot write to stdout: {}", std::generic_category().message(stdoutError));
}

}  // namespace woodcock::tool
