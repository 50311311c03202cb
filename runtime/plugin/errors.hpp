#pragma once

// How the functions of the ABI run, and what they say of their failures.

#include <exception>
#include <new>
#include <string>
#include <string_view>

#include "runtime/core/check.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/sized.hpp"

namespace espalier {

// Logs the message and keeps it for espLastError; returns the code. context: not null, here and below.
EspResult fail(const EspContext* context, EspResult code, std::string message);
constexpr const char* kNoMemory = "out of memory";  // short enough to take none
// Likewise a file's mistakes, as INVALID_CONTENT.
EspResult failContent(const EspContext* context, const Failure& failure);
// For failures of GPU work: NO_DEVICE, DEVICE_LOST, OUT_OF_MEMORY or DRIVER_FAILED.
EspResult gpuCode(const Device& device, const Failure& failure);
EspResult failGpu(const EspContext* context, const Failure& failure);
// For work that may also refuse what it is given, as INVALID_CONTENT.
EspResult failWork(const EspContext* context, const Failure& failure);
// The whole file into `bytes`, from where the context's files are: OK, or IO_FAILED.
EspResult readWhole(const EspContext* context, const std::string& path, std::vector<std::byte>& bytes);

// Runs what grows: want of the host's own memory is a failure like that of the GPU's.
template <class F>
EspResult grownOr(const EspContext& context, F&& body) {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        return fail(&context, ESP_OUT_OF_MEMORY, kNoMemory);
    }
}

// What espLastError(NULL) tells: why this thread's last call without a context failed.
std::string& errorAlone();
inline EspResult failAlone(EspResult code, std::string_view message) noexcept {
    try {
        errorAlone() = message;
    } catch (...) {  // no memory for it: the code has to do
        errorAlone().clear();
    }
    return code;
}
// Runs a function of the ABI. No exception leaves it. bare: also while the context lacks what lies on its device.
template <class F>
EspResult guarded(const EspContext* context, F&& body, bool bare = false) noexcept {
    try {
        if (!context) return failAlone(ESP_INVALID_ARGUMENT, "there is no context: it is null");
        context->error.clear();
        if (context->bare && !bare)
            return fail(context, ESP_DEVICE_LOST, "the GPU was lost, and espRecreate has not succeeded since");
        return body();
    } catch (const Refusal& refusal) {
        return fail(context, ESP_INVALID_ARGUMENT, refusal.why);
    } catch (const std::bad_alloc&) {
        return fail(context, ESP_OUT_OF_MEMORY, kNoMemory);
    } catch (const InternalError& e) {
        return fail(context, ESP_INTERNAL_ERROR, e.what());
    } catch (const std::exception& e) {
        return fail(context, ESP_INVALID_CONTENT, e.what());
    } catch (...) {
        return fail(context, ESP_INVALID_CONTENT, "unknown error");
    }
}

// The same for functions without a context.
template <class F>
EspResult guardedAlone(F&& body) noexcept {
    try {
        errorAlone().clear();
        return body();
    } catch (const Refusal& refusal) {
        return failAlone(ESP_INVALID_ARGUMENT, refusal.why);
    } catch (const std::bad_alloc&) {
        return failAlone(ESP_OUT_OF_MEMORY, kNoMemory);
    } catch (const InternalError& e) {
        return failAlone(ESP_INTERNAL_ERROR, e.what());
    } catch (const std::exception& e) {
        return failAlone(ESP_INVALID_CONTENT, e.what());
    } catch (...) {
        return failAlone(ESP_INVALID_CONTENT, "unknown error");
    }
}

// Fills a host's struct with defaults.
template <class T>
EspResult giveDefaults(const char* call, T* out) noexcept {
    return guardedAlone([&] {
        T def{};
        setDefaults(def);
        give(call, out, def);
        return ESP_OK;
    });
}

}  // namespace espalier
