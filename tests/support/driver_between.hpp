#pragma once

#include <map>
#include <string>

#include "runtime/gpu/device.hpp"

namespace espalier::test {

// What a game would do to hand its device in: here by way of a Device of ours, whose handles we borrow.
inline HostDevice hostOf(Device& device) {
    HostDevice host;
    host.getInstanceProcAddr = device.getInstanceProcAddr();
    host.instance = device.instance();
    host.physicalDevice = device.physicalDevice();
    host.device = device.handle();
    host.queue = device.queue();
    host.queueFamily = device.info().queueFamily;
    host.debugUtils = true;
    return host;
}

// A driver between an adopted Device and the real one, some of whose functions are a test's own. One at a time:
// Vulkan's functions carry no pointer of ours.
class DriverBetween {
  public:
    explicit DriverBetween(Device& real) : real_(real) {
        instanceProc_ = real.getInstanceProcAddr();
        instead_.clear();
    }
    // From the next adoption on.
    template <class Function>
    void replace(const char* name, Function* function) {
        instead_[name] = reinterpret_cast<PFN_vkVoidFunction>(function);
    }
    HostDevice host() const {
        HostDevice host = hostOf(real_);
        host.getInstanceProcAddr = instanceFunction;
        return host;
    }

  private:
    static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instanceFunction(VkInstance instance, const char* name) {
        if (auto own = instead_.find(name); own != instead_.end()) return own->second;
        const PFN_vkVoidFunction real = instanceProc_(instance, name);
        if (std::string(name) != "vkGetDeviceProcAddr") return real;
        deviceProc_ = reinterpret_cast<PFN_vkGetDeviceProcAddr>(real);
        return reinterpret_cast<PFN_vkVoidFunction>(&deviceFunction);
    }
    static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL deviceFunction(VkDevice device, const char* name) {
        auto own = instead_.find(name);
        return own != instead_.end() ? own->second : deviceProc_(device, name);
    }

    Device& real_;
    static inline PFN_vkGetInstanceProcAddr instanceProc_ = nullptr;
    static inline PFN_vkGetDeviceProcAddr deviceProc_ = nullptr;
    static inline std::map<std::string, PFN_vkVoidFunction> instead_;
};

}  // namespace espalier::test
