// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>

namespace woodcock::convert {

/// Called from time to time, by one thread at a time, with the fraction of the work that is done, 0
/// to 1. If it throws, the work ends, and the exception reaches the caller.
using WorkProgress = std::function<void(double fraction)>;

/// Counts the steps of several threads.
class WorkCounter {
public:
    WorkCounter(const WorkProgress& progress, std::uint64_t steps)
        : progress_(progress), steps_(steps) {}

    void add(std::uint64_t steps) {
        const std::uint64_t done = done_ += steps;
        if (!progress_) return;
        const std::unique_lock lock(mutex_, std::try_to_lock);
        if (lock) progress_(static_cast<double>(done) / static_cast<double>(steps_));
    }

private:
    const WorkProgress& progress_;
    const std::uint64_t steps_;
    std::atomic<std::uint64_t> done_ = 0;
    std::mutex mutex_;
};

}  // namespace woodcock::convert
