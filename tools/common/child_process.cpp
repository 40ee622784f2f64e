// SPDX-License-Identifier: Apache-2.0
#include "tools/common/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "woodcock/base/error.h"

namespace woodcock::tool {

namespace {

constexpr std::size_t keptLines = 20;
constexpr std::size_t longestLine = 4096;

class Pipe {
public:
    Pipe() {
        if (pipe2(ends_.data(), O_CLOEXEC) != 0)
            throw failure("cannot make a pipe: {}", std::strerror(errno));
    }
    ~Pipe() { closeReading(), closeWriting(); }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;

    int reading() const { return ends_[0]; }
    int writing() const { return ends_[1]; }
    void closeReading() { closeEnd(0); }
    void closeWriting() { closeEnd(1); }

private:
    void closeEnd(std::size_t i) {
        if (ends_[i] >= 0) close(ends_[i]);
        ends_[i] = -1;
    }
    std::array<int, 2> ends_{-1, -1};
};

/// In the child: becomes the program, or tells why not.
[[noreturn]] void execute(char* const* argv, const Pipe& output, const Pipe& problem) {
    setpgid(0, 0);  // what it starts ends with it
    for (const int ignored : {SIGPIPE, SIGXFSZ}) signal(ignored, SIG_DFL);
    const int nothing = open("/dev/null", O_RDONLY);
    dup2(nothing, STDIN_FILENO);
    dup2(output.writing(), STDOUT_FILENO);
    dup2(output.writing(), STDERR_FILENO);
    execvp(argv[0], argv);
    const int reason = errno;
    if (write(problem.writing(), &reason, sizeof reason) < 0) _exit(126);
    _exit(127);
}

/// Cuts what is read into lines and keeps the last ones.
class Lines {
public:
    explicit Lines(const std::function<void(const std::string&)>& onLine) : onLine_(onLine) {}

    void add(const char* text, std::size_t size) {
        for (std::size_t i = 0; i < size; ++i) {
            if (text[i] == '\n' || text[i] == '\r')
                finish();
            else if (line_.size() < longestLine)
                line_ += text[i];
        }
    }
    void finish() {
        if (line_.empty()) return;
        onLine_(line_);
        if (last_.size() == keptLines) last_.erase(last_.begin());
        last_.push_back(std::exchange(line_, {}));
    }
    std::vector<std::string> takeLast() { return std::move(last_); }

private:
    const std::function<void(const std::string&)>& onLine_;
    std::string line_;
    std::vector<std::string> last_;
};

/// Whether there was something, waiting for it a little.
bool readSome(int from, Lines& lines, int milliseconds) {
    pollfd waiting{from, POLLIN, 0};
    if (poll(&waiting, 1, milliseconds) <= 0) return false;
    std::array<char, 4096> buffer;
    const ssize_t size = read(from, buffer.data(), buffer.size());
    if (size > 0) lines.add(buffer.data(), static_cast<std::size_t>(size));
    return size > 0;
}

}  // namespace

ChildResult runChild(const std::vector<std::string>& command,
                     const std::function<void(const std::string&)>& onLine,
                     const std::function<bool()>& shouldStop, std::chrono::seconds patience) {
    std::vector<char*> argv;
    for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    Pipe output, problem;
    const pid_t child = fork();
    if (child < 0) throw failure("cannot start a process: {}", std::strerror(errno));
    if (child == 0) execute(argv.data(), output, problem);
    setpgid(child, child);  // whichever of the two comes first
    output.closeWriting();
    problem.closeWriting();
    int reason = 0;
    const bool started = read(problem.reading(), &reason, sizeof reason) <= 0;

    ChildResult result;
    Lines lines(onLine);
    int status = 0;
    std::chrono::steady_clock::time_point asked;
    while (waitpid(child, &status, WNOHANG) == 0) {
        const bool some = readSome(output.reading(), lines, 50);
        if (!some) usleep(5000);  // at its end, poll does not wait
        const auto now = std::chrono::steady_clock::now();
        if (!result.stopped && shouldStop()) {
            result.stopped = true, asked = now;
            kill(-child, SIGTERM);
        } else if (result.stopped && now - asked > patience) {
            kill(-child, SIGKILL);
        }
    }
    kill(-child, SIGKILL);  // what it left behind
    if (!started) throw usageError("cannot start '{}': {}", command[0], std::strerror(reason));
    while (readSome(output.reading(), lines, 0)) {
    }
    lines.finish();
    result.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.lastLines = lines.takeLast();
    return result;
}

}  // namespace woodcock::tool
