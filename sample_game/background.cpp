// Jobs -> one piece of work at a time, moved on by the frames.
#include "sample_game/background.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace sample {
namespace {

using espalier::document::Work;

constexpr double kSlow = .3;  // seconds

double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

void Background::ask(Job job) {
    if (jobs_.empty()) asked_ = seconds();
    if (!job.title.empty()) giveWay();
    for (size_t i = work_ ? 1 : 0; i < jobs_.size(); ++i)
        if (jobs_[i].title == job.title) return void(jobs_[i] = std::move(job));
    jobs_.push_back(std::move(job));
}

void Background::begin() {
    if (work_) return;
    work_ = std::make_unique<Work>(jobs_.front().plan());
    if (jobs_.front().cancelled) work_->cancel();
}

bool Background::step() {
    if (jobs_.empty()) return false;
    begin();
    const float before = work_->progress();
    if (work_->step()) return work_->reading() || work_->progress() != before;
    end();
    return true;
}

// What is told of the end may ask for more.
void Background::end() {
    const std::unique_ptr<Work> over = std::move(work_);
    const Job job = std::move(jobs_.front());
    jobs_.pop_front();
    asked_ = seconds();
    job.ended(*over);
}

void Background::settle() {
    if (work_) work_->settle();
}

void Background::cancel() {
    if (work_) work_->cancel();
}

void Background::cancelLast() {
    if (jobs_.size() == 1) cancel();
    if (busy()) jobs_.back().cancelled = true;
}

void Background::giveWay() {
    if (work_ && jobs_.front().title.empty()) work_->cancel();
    for (size_t i = work_ ? 1 : 0; i < jobs_.size();)
        if (jobs_[i].title.empty())
            jobs_.erase(jobs_.begin() + ptrdiff_t(i));
        else
            ++i;
}

void Background::leave() {
    for (Job& job : jobs_) job.cancelled = job.cancelled || job.leavesWithDocument;
    if (work_ && jobs_.front().cancelled) work_->cancel();
}

void Background::finish() {
    std::string told;
    while (busy()) {
        begin();
        (void)work_->finish(told);
        end();
    }
}

bool Background::slow() const {
    return busy() && !title().empty() && seconds() > asked_ + kSlow;
}

}  // namespace sample
