// Pieces of a range, taken by threads from one counter.
#include "runtime/core/jobs.hpp"

#include <algorithm>
#include <utility>

namespace espalier {

Crew::Crew(unsigned threads) : threads_(std::max(1u, threads ? threads : std::thread::hardware_concurrency())) {}

Crew::~Crew() {
    body_ = nullptr;
    range_.fetch_add(1, std::memory_order_release);
    range_.notify_all();
    others_.clear();  // joins
}

void Crew::gather() {
    try {
        while (others_.size() + 1 < threads_) others_.emplace_back([this] { workOn(); });
    } catch (const std::exception&) {
        threads_ = unsigned(others_.size()) + 1;  // the machine has no more to give: these do the work
    }
}

void Crew::takePieces() {
    try {
        for (size_t piece = next_++; piece < pieces_; piece = next_++)
            (*body_)(piece * grain_, std::min(count_, (piece + 1) * grain_));
    } catch (...) {
        next_ = pieces_;
        if (!thrown_.exchange(true)) exception_ = std::current_exception();
    }
}

void Crew::rethrow() {
    if (thrown_.exchange(false)) std::rethrow_exception(std::exchange(exception_, nullptr));
}

void Crew::workOn() {
    for (unsigned seen = 0;;) {
        range_.wait(seen, std::memory_order_acquire);
        seen += 1;  // a range begins when all have ended the one before, so none is missed
        if (!body_) return;
        takePieces();
        if (--atWork_ == 0) atWork_.notify_one();
    }
}

void Crew::overRange(size_t count, size_t grain, const Body& body) {
    count_ = count;
    grain_ = std::max<size_t>(grain, 1);
    pieces_ = count / grain_ + (count % grain_ != 0);
    body_ = &body;
    next_ = 0;
    if (threads_ == 1 || pieces_ < 2) {
        takePieces();
        return rethrow();
    }
    gather();
    atWork_ = unsigned(others_.size());
    range_.fetch_add(1, std::memory_order_release);
    range_.notify_all();
    takePieces();
    for (unsigned busy = atWork_; busy > 0; busy = atWork_) atWork_.wait(busy);
    rethrow();
}

void parallelFor(size_t count, size_t grain, const Crew::Body& body, unsigned threads) {
    const size_t pieces = count / std::max<size_t>(grain, 1) + 1;
    const unsigned machine = threads ? threads : std::thread::hardware_concurrency();
    Crew(unsigned(std::clamp<size_t>(machine, 1, pieces))).overRange(count, grain, body);
}

}  // namespace espalier
