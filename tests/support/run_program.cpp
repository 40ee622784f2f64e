// SPDX-License-Identifier: Apache-2.0
#include "tests/support/run_program.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>

#include "tests/support/paths.h"

namespace woodcock::test {

namespace {

/// In the child: becomes the program, or ends with 127.
[[noreturn]] void execute(const std::vector<std::string>& arguments, int out, int err,
                          std::optional<std::size_t> fileSizeLimit) {
    const int in = open("/dev/null", O_RDONLY);
    dup2(in, STDIN_FILENO);
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    if (fileSizeLimit) {
        const rlimit limit{*fileSizeLimit, *fileSizeLimit};
        setrlimit(RLIMIT_FSIZE, &limit);
        ::signal(SIGXFSZ, SIG_IGN);
    }
    const std::string name = program().string();
    std::vector<char*> argv{const_cast<char*>(name.c_str())};
    for (const std::string& argument : arguments)
        argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    execv(name.c_str(), argv.data());
    _exit(127);
}

int waitFor(pid_t process) {
    int status = 0;
    if (waitpid(process, &status, 0) != process) throw std::runtime_error("waitpid failed");
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

int openFor(const std::filesystem::path& file) {
    const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    if (descriptor < 0) throw std::runtime_error("cannot write " + file.string());
    return descriptor;
}

}  // namespace

ProgramResult runProgram(const std::vector<std::string>& arguments,
                         std::optional<std::size_t> fileSizeLimit) {
    const TempDir dir;
    const int out = openFor(dir / "out"), err = openFor(dir / "err");
    const pid_t process = fork();
    if (process == 0) execute(arguments, out, err, fileSizeLimit);
    close(out);
    close(err);
    ProgramResult result;
    result.exitCode = waitFor(process);
    result.out = readText(dir / "out");
    result.err = readText(dir / "err");
    return result;
}

RunningProgram::RunningProgram(const std::vector<std::string>& arguments) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    process_ = fork();
    if (process_ == 0) execute(arguments, open("/dev/null", O_WRONLY), ends[1], {});
    close(ends[1]);
    err_ = fdopen(ends[0], "r");
}

RunningProgram::~RunningProgram() {
    if (process_ > 0) {
        kill(process_, SIGKILL);
        waitpid(process_, nullptr, 0);
    }
    fclose(err_);
}

std::string RunningProgram::awaitLine(const std::string& text) {
    std::string line;
    for (int c; (c = getc(err_)) != EOF;) {
        if (c != '\n') {
            line += static_cast<char>(c);
            continue;
        }
        if (line.find(text) != std::string::npos) return line;
        line.clear();
    }
    return {};
}

void RunningProgram::signal(int number) { kill(process_, number); }

ProgramResult RunningProgram::wait() {
    ProgramResult result;
    for (int c; (c = getc(err_)) != EOF;) result.err += static_cast<char>(c);
    result.exitCode = waitFor(process_);
    process_ = -1;
    return result;
}

}  // namespace woodcock::test
