// SPDX-License-Identifier: Apache-2.0
#include "tests/support/run_program.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tests/support/paths.h"
#include "tests/support/program_starter.h"
#include "tests/support/start_request.h"

namespace woodcock::test {

namespace {

/// In the child: becomes the program, or ends with 127.
[[noreturn]] void execute(const std::string& name, const std::vector<std::string>& arguments,
                          int out, int err, const ProgramLimits& limits) {
    const int in = open("/dev/null", O_RDONLY);
    dup2(in, STDIN_FILENO);
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    if (limits.fileSize) {
        const rlimit limit{*limits.fileSize, *limits.fileSize};
        setrlimit(RLIMIT_FSIZE, &limit);
        ::signal(SIGXFSZ, SIG_IGN);
    }
    if (limits.addressSpace) {
        const rlimit limit{*limits.addressSpace, *limits.addressSpace};
        setrlimit(RLIMIT_AS, &limit);
    }
    if (limits.seconds > 0) {
        const rlimit limit{limits.seconds, limits.seconds};
        setrlimit(RLIMIT_CPU, &limit);
        alarm(12 * limits.seconds);  // one that waits, on a machine that may be busy
    }
    std::vector<char*> argv{const_cast<char*>(name.c_str())};
    for (const std::string& argument : arguments)
        argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    execv(name.c_str(), argv.data());
    _exit(127);
}

void waitFor(const StartedProgram& started, ProgramResult& result) {
    StartEnd end{};
    if (started.end >= 0) {
        if (read(started.end, &end, sizeof end) != sizeof end)
            throw std::runtime_error("no word of the program's end");
        close(started.end);
    } else {
        rusage used{};
        if (wait4(started.process, &end.status, 0, &used) != started.process)
            throw std::runtime_error("wait4 failed");
        end.residentKiB = used.ru_maxrss;
    }
    result.exitCode = WIFEXITED(end.status) ? WEXITSTATUS(end.status) : 128 + WTERMSIG(end.status);
    result.residentBytes = static_cast<std::size_t>(end.residentKiB) * 1024;
}

/// Programs within limits start as ever, as their memory counts from the first byte.
StartedProgram start(const std::string& name, const std::vector<std::string>& arguments, int out,
                     int err, const ProgramLimits& limits) {
    const bool limited = limits.fileSize || limits.addressSpace || limits.seconds > 0;
    if (canStartAgain() && !limited && name == program()) return startAgain(arguments, out, err);
    const pid_t process = fork();
    if (process == 0) execute(name, arguments, out, err, limits);
    return {process, -1};
}

int openFor(const std::filesystem::path& file) {
    const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    if (descriptor < 0) throw std::runtime_error("cannot write " + file.string());
    return descriptor;
}

}  // namespace

ProgramResult runProgram(const std::vector<std::string>& arguments, const ProgramLimits& limits,
                         const std::filesystem::path& program) {
    const std::string name = (program.empty() ? test::program() : program).string();
    const TempDir dir;
    const int out = openFor(dir / "out"), err = openFor(dir / "err");
    const StartedProgram started = start(name, arguments, out, err, limits);
    close(out);
    close(err);
    ProgramResult result;
    waitFor(started, result);
    result.out = readText(dir / "out");
    result.err = readText(dir / "err");
    return result;
}

RunningProgram::RunningProgram(const std::vector<std::string>& arguments) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    const int out = open("/dev/null", O_WRONLY | O_CLOEXEC);
    started_ = start(program().string(), arguments, out, ends[1], {});
    close(out);
    close(ends[1]);
    err_ = fdopen(ends[0], "r");
}

RunningProgram::~RunningProgram() {
    if (started_.process > 0) {
        signal(SIGKILL);
        ProgramResult ignored;
        waitFor(started_, ignored);
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

bool RunningProgram::awaitSamples(int samples) {
    for (std::string line; !(line = awaitLine("\"event\":\"progress\"")).empty();)
        if (nlohmann::json::parse(line).at("samples") >= samples) return true;
    return false;
}

void RunningProgram::signal(int number) { kill(started_.process, number); }

ProgramResult RunningProgram::wait() {
    ProgramResult result;
    for (int c; (c = getc(err_)) != EOF;) result.err += static_cast<char>(c);
    waitFor(started_, result);
    started_ = {};
    return result;
}

}  // namespace woodcock::test
