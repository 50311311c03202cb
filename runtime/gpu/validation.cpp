// The validation layer's messages, counted, with the first texts kept and logged.
#include "runtime/gpu/validation.hpp"

namespace espalier {
namespace {
constexpr size_t kKeptTexts = 16;
}

std::vector<std::string> ValidationLog::texts() const {
    std::lock_guard lock(mutex_);
    return texts_;
}

VkDebugUtilsMessengerCreateInfoEXT ValidationLog::messengerInfo() {
    VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    // Not the loader's own chatter (type GENERAL), which is about drivers on the machine and not about our calls.
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = receive;
    info.pUserData = this;
    return info;
}

VkBool32 ValidationLog::receive(VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT,
                                const VkDebugUtilsMessengerCallbackDataEXT* data, void* self) {
    auto& log = *static_cast<ValidationLog*>(self);
    ++log.count_;
    std::lock_guard lock(log.mutex_);
    if (log.texts_.size() >= kKeptTexts) return VK_FALSE;
    log.texts_.emplace_back(data->pMessage ? data->pMessage : "");
    const bool error = severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    if (log.log_) log.log_(error ? Severity::error : Severity::warning, log.texts_.back());
    return VK_FALSE;
}

}  // namespace espalier
