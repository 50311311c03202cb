#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <vector>

#include "runtime/core/log.hpp"
#include "runtime/gpu/functions.hpp"

namespace espalier {

// Counts what the validation layer says. Its address must not change: the messenger holds it.
class ValidationLog {
  public:
    explicit ValidationLog(Log log) : log_(std::move(log)) {}
    uint32_t count() const { return count_; }
    std::vector<std::string> texts() const;

    // What a messenger, or the creation of an instance, needs to report here.
    VkDebugUtilsMessengerCreateInfoEXT messengerInfo();

  private:
    static VKAPI_ATTR VkBool32 VKAPI_CALL receive(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                  VkDebugUtilsMessageTypeFlagsEXT types,
                                                  const VkDebugUtilsMessengerCallbackDataEXT* data, void* self);
    Log log_;
    std::atomic<uint32_t> count_ = 0;
    mutable std::mutex mutex_;
    std::vector<std::string> texts_;
};

}  // namespace espalier
