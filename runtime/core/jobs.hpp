#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <thread>
#include <vector>

namespace espalier {

// Calls body(begin, end) over [0, count) in pieces of at most `grain`, on up to `threads` threads (0: as many as
// the machine has), the calling one among them, and returns when all pieces are done. The cut into pieces doesn't
// depend on the number of threads; their order does. What the body throws is thrown here, the first of it, when all
// threads have ended their pieces; pieces that weren't begun by then are left out.
void parallelFor(size_t count, size_t grain, const std::function<void(size_t begin, size_t end)>& body,
                 unsigned threads = 0);

// Threads for many such ranges one after the other. They begin with the first range of more than one piece and end with
// the crew; in between they sleep.
class Crew {
  public:
    using Body = std::function<void(size_t begin, size_t end)>;

    explicit Crew(unsigned threads = 0);  // as parallelFor's
    ~Crew();
    Crew(const Crew&) = delete;
    Crew& operator=(const Crew&) = delete;

    // As parallelFor. One thread at a time may call it, and no body.
    void overRange(size_t count, size_t grain, const Body& body);
    unsigned threads() const { return threads_; }

  private:
    void gather();
    void workOn();
    void takePieces();
    void rethrow();

    unsigned threads_;
    std::vector<std::jthread> others_;
    // The range under way; those who sleep wait for `range_` to change.
    const Body* body_ = nullptr;
    size_t count_ = 0, grain_ = 1, pieces_ = 0;
    std::atomic<size_t> next_ = 0;
    std::atomic<unsigned> range_ = 0, atWork_ = 0;
    std::atomic<bool> thrown_ = false;
    std::exception_ptr exception_;  // the first of the range, read when all have ended it
};

}  // namespace espalier
