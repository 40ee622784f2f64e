// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace woodcock::render {

/// Calls a function again and again, from a thread of its own, until it is destroyed.
class RepeatedCall {
public:
    /// An empty function is never called, and costs no thread.
    RepeatedCall(std::chrono::milliseconds pause, std::function<void()> call) {
        if (call)
            thread_ = std::thread([this, pause, call = std::move(call)] {
                std::unique_lock lock(mutex_);
                while (!wake_.wait_for(lock, pause, [this] { return done_; })) call();
            });
    }
    ~RepeatedCall() {
        if (!thread_.joinable()) return;
        {
            const std::lock_guard lock(mutex_);
            done_ = true;
        }
        wake_.notify_one();
        thread_.join();
    }
    RepeatedCall(const RepeatedCall&) = delete;
    RepeatedCall& operator=(const RepeatedCall&) = delete;

private:
    std::mutex mutex_;
    std::condition_variable wake_;
    bool done_ = false;
    std::thread thread_;
};

}  // namespace woodcock::render
