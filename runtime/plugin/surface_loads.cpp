// Enters: requests. Leaves: surfaces of the context, some updates later.
#include "runtime/plugin/surface_loads.hpp"

#include <new>
#include <utility>

#include "runtime/gpu/color_texture.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"

namespace espalier {

bool SurfaceLoads::rootsOf(const EspContext& context) {
    return holdsRoots(*context.device);
}

SurfaceLoads::~SurfaceLoads() {
    stopThread();
}

void SurfaceLoads::startThread() {
    if (!thread_.joinable()) thread_ = std::jthread([this](std::stop_token stop) { work(std::move(stop)); });
    changed_.notify_all();
}

// When it has done what it is at.
void SurfaceLoads::stopThread() {
    if (!thread_.joinable()) return;
    {
        const std::lock_guard lock(mutex_);
        rests_ = true;
    }
    thread_.request_stop();
    thread_.join();
    rests_ = false;
}

void SurfaceLoads::beginAnew() {
    stopThread();
    for (auto& [id, load] : loads_) {
        if (load->step == Step::over) continue;
        load->read.reset();
        load->failure.reset();
        load->failed = ESP_OK;
        load->file.reset();
        load->state.state = ESP_LOAD_READING;
        load->step = Step::waits;
        const bool needsFile = load->request.bytes || context_.files.fromHost();
        if (load->ended || !needsFile) continue;
        if (EspResult unread = readFileOf(context_, load->request, load->file.emplace()))
            fail(*load, unread, std::exchange(context_.error, {}));
    }
    ahead_ = 0;
    roots_ = rootsOf(context_);
    const auto waits = [](const auto& load) { return load.second->step == Step::waits; };
    if (std::ranges::any_of(loads_, waits)) startThread();
}

uint32_t SurfaceLoads::begin(SurfaceRequest request, std::optional<std::vector<std::byte>> file, uint32_t into) {
    auto load = std::make_unique<Load>();
    load->request = std::move(request);
    load->file = std::move(file);
    load->into = into;
    {
        const std::lock_guard lock(mutex_);
        loads_.emplace(++last_, std::move(load));
    }
    startThread();
    return last_;
}

const SurfaceLoads::State* SurfaceLoads::find(uint32_t id) const {
    const auto found = loads_.find(id);
    return found == loads_.end() || found->second->ended ? nullptr : &found->second->state;
}

bool SurfaceLoads::end(uint32_t id) {
    const auto found = loads_.find(id);
    if (found == loads_.end() || found->second->ended) return false;
    const std::lock_guard lock(mutex_);
    found->second->ended = true;  // the thread may be at it: advance() lets go of it
    return true;
}

void SurfaceLoads::limit(const Limits& limits) {
    {
        const std::lock_guard lock(mutex_);
        limits_ = limits;
    }
    changed_.notify_all();
}

// What is to be filled holds memory of the device, so it comes first.
SurfaceLoads::Load* SurfaceLoads::nextJob() {
    if (rests_) return nullptr;
    Load* unread = nullptr;
    for (const auto& [id, load] : loads_) {
        if (load->step == Step::fills) return load.get();
        if (!unread && load->step == Step::waits && !load->ended) unread = load.get();
    }
    if (!unread || (ahead_ > 0 && ahead_ >= limits_.bytesAhead)) return nullptr;
    unread->step = Step::reads;
    return unread;
}

void SurfaceLoads::work(std::stop_token stop) {
    std::unique_lock lock(mutex_);
    while (true) {
        Load* job = nullptr;
        if (!changed_.wait(lock, stop, [&] { return (job = nextJob()) != nullptr; })) return;
        const bool fills = job->step == Step::fills;
        lock.unlock();
        if (fills)
            job->read->upload.fill();
        else
            read(*job);
        lock.lock();
        if (fills) {
            job->step = Step::filled;
        } else {
            if (job->read) ahead_ += job->read->upload.bytes();
            job->step = Step::hasRead;
        }
    }
}

void SurfaceLoads::read(Load& load) noexcept {
    try {
        if (!load.file) {
            Result<std::vector<std::byte>> file = Files().read(load.request.name);
            if (!file) {
                load.failure = file.failure();
                load.failed = ESP_IO_FAILED;
                return;
            }
            load.file = std::move(*file);
        }
        Result<SurfaceRead> read = readSurface(std::move(*load.file), load.request, roots_);
        if (read)
            load.read = std::move(*read);
        else
            load.failure = read.failure(), load.failed = ESP_INVALID_CONTENT;
    } catch (const std::bad_alloc&) {
        load.failed = ESP_OUT_OF_MEMORY;
    } catch (...) {
        load.failed = ESP_INTERNAL_ERROR;
    }
    load.file.reset();
}

void SurfaceLoads::fail(Load& load, EspResult result, std::string message) {
    load.state.state = ESP_LOAD_FAILED;
    load.state.result = result;
    load.state.message = std::move(message);
    load.read.reset();
    if (load.into && !load.ended) context_.streaming->failed(load.into, result, load.state.message);
    const std::lock_guard lock(mutex_);
    load.step = Step::over;
}

void SurfaceLoads::take(Load& load) {
    if (load.failed == ESP_INVALID_CONTENT) {
        (void)failContent(&context_, *load.failure);
        return fail(load, load.failed, std::exchange(context_.error, {}));
    }
    if (load.failed != ESP_OK) {
        const std::string why = load.failure ? load.failure->text() : load.request.name + ": " + kNoMemory;
        (void)espalier::fail(&context_, load.failed, why);
        return fail(load, load.failed, std::exchange(context_.error, {}));
    }
    load.state.bytes = load.read->upload.bytes();
    if (Status allocated = load.read->upload.allocate(*context_.device); !allocated) {
        const EspResult code = failGpu(&context_, allocated.failure());
        return fail(load, code, std::exchange(context_.error, {}));
    }
    load.state.state = ESP_LOAD_UPLOADING;
    const std::lock_guard lock(mutex_);
    load.step = Step::fills;
}

void SurfaceLoads::place(Load& load) {
    EspResult result = ESP_OK;
    if (Status submitted = load.read->upload.submit(*context_.device); !submitted)
        result = failGpu(&context_, submitted.failure());
    else if (load.into)
        result = context_.streaming->stand(load.into, std::move(*load.read));
    else
        result = standSurface(context_, "espBeginLoad: ", std::move(*load.read), &load.state.surface);
    if (result != ESP_OK) return fail(load, result, std::exchange(context_.error, {}));
    load.state.state = ESP_LOAD_STANDS;
    load.read.reset();
    const std::lock_guard lock(mutex_);
    load.step = Step::over;
}

void SurfaceLoads::advance() {
    uint64_t begun = 0;
    bool any = false;
    std::vector<uint32_t> done;
    for (auto& [id, load] : loads_) {
        Step step;
        Limits limits;
        {
            const std::lock_guard lock(mutex_);
            step = load->step;
            limits = limits_;
        }
        if (load->ended && step != Step::reads && step != Step::fills) {
            done.push_back(id);
        } else if (step == Step::hasRead) {
            const uint64_t bytes = load->read ? load->read->upload.bytes() : 0;
            if (begun > 0 && begun + bytes > limits.bytesPerUpdate) continue;
            if (load->into && load->read && !context_.streaming->makeRoom(id, bytes)) continue;
            begun += bytes;
            take(*load);
            const std::lock_guard lock(mutex_);
            ahead_ -= bytes;
            any = true;
        } else if (step == Step::filled) {
            place(*load);
        }
    }
    for (const uint32_t id : done) {
        const std::lock_guard lock(mutex_);
        Load& load = *loads_[id];
        if (load.step == Step::hasRead && load.read) ahead_ -= load.read->upload.bytes();
        loads_.erase(id);
        any = true;
    }
    if (any) changed_.notify_all();
}

}  // namespace espalier
