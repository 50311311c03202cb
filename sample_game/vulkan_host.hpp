#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sample_game/volk_include.hpp"

struct GLFWwindow;

namespace sample {

// What a frame is recorded with.
struct Frame {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkExtent2D extent{};
    uint64_t number = 0;    // from 1, rising
    uint64_t finished = 0;  // frames up to this one are done on the GPU
    uint32_t slot = 0;      // below kFramesInFlight: what may be written anew for this frame
    bool overlaps = false;  // it is drawn while the next is recorded, and shown when that is
};

constexpr uint32_t kFramesInFlight = 2;

// Of a colour image, from all work before to all work after.
void imageBarrier(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to);
// The window's image to one colour; leaves it in COLOR_ATTACHMENT_OPTIMAL.
void clear(const Frame& frame, const VkClearColorValue& colour);

// The sample's own instance, device, queue and swapchain, as a game engine has them before it loads Espalier.
// Errors end a call with a message in error(); after a lost device nothing but destruction is possible.
class VulkanHost {
  public:
    VulkanHost() = default;
    VulkanHost(const VulkanHost&) = delete;
    VulkanHost& operator=(const VulkanHost&) = delete;
    ~VulkanHost();

    // `features` and `extensions` are what the plugin asks of a host's device.
    bool create(GLFWwindow* window, bool validation, const void* features, const char* const* extensions,
                uint32_t extensionCount);

    // Waits for the slot's earlier frame, on software devices for the last one unless it `overlaps`, and takes the next
    // image. Nothing: the window has no area, or the swapchain was made anew; try again after events. error() is not
    // empty after a failure.
    std::optional<Frame> begin(bool overlaps = false);
    // Ends, submits and shows what was recorded. The image must be in COLOR_ATTACHMENT_OPTIMAL. `picture`: if not
    // null it is given the frame's pixels, RGBA, rows top to bottom (the call waits for the GPU then), or why there
    // are none.
    using TakePicture =
        std::function<void(std::vector<uint8_t> rgba, uint32_t width, uint32_t height, const std::string& error)>;
    bool end(const Frame& frame, const TakePicture& picture = {});
    void waitIdle() const;

    const std::string& error() const { return error_; }
    VkInstance instance() const { return instance_; }
    VkPhysicalDevice physicalDevice() const { return physicalDevice_; }
    VkDevice device() const { return device_; }
    VkQueue queue() const { return queue_; }
    uint32_t queueFamily() const { return queueFamily_; }
    VkFormat format() const { return format_; }
    uint32_t validationMessages() const { return validationMessages_; }
    const VkDeviceCreateInfo& deviceInfo() const { return deviceInfo_; }  // features and extensions that it has
    bool validation() const { return messenger_ != VK_NULL_HANDLE; }

    // A memory type that has the wanted properties; false where the machine has none.
    bool findMemory(uint32_t allowedTypes, VkMemoryPropertyFlags wanted, uint32_t& type) const;

  private:
    bool makeInstance(bool validation);
    bool makeDevice(const void* features, const char* const* extensions, uint32_t extensionCount);
    bool makeFrames();
    bool makeSwapchain();
    void dropSwapchain();
    bool check(VkResult result, const char* what);
    bool copyPicture(const Frame& frame);
    bool submit(const Frame& frame);
    bool show(uint32_t target);
    static VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                                    VkDebugUtilsMessageTypeFlagsEXT,
                                                    const VkDebugUtilsMessengerCallbackDataEXT* data, void* self);

    struct Slot {
        VkCommandPool pool = VK_NULL_HANDLE;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        VkFence done = VK_NULL_HANDLE;
        VkSemaphore acquired = VK_NULL_HANDLE;
        uint64_t number = 0;  // of the frame that was last submitted with it
    };
    struct Target {
        VkImage image = VK_NULL_HANDLE;
        VkImageView view = VK_NULL_HANDLE;
        VkSemaphore drawn = VK_NULL_HANDLE;
    };

    GLFWwindow* window_ = nullptr;
    std::string error_;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice_ = VK_NULL_HANDLE;
    VkPhysicalDeviceMemoryProperties memory_{};
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    uint32_t queueFamily_ = 0;
    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    VkFormat format_ = VK_FORMAT_UNDEFINED;
    VkExtent2D extent_{};
    bool canCopy_ = false;
    bool stale_ = true;
    Slot slots_[kFramesInFlight];
    std::vector<Target> targets_;
    uint32_t target_ = 0;
    std::optional<uint32_t> held_;  // the target of a frame that isn't shown yet
    uint64_t frameNumber_ = 0;
    uint64_t finished_ = 0;
    // Whether each frame is recorded while the last is drawn. On software devices only those that change nothing but
    // the camera, since native code changes in place what no frame under way reads. Showing a frame waits there until
    // it is drawn, so that is put off until the next has been recorded.
    VkPhysicalDeviceFeatures2 features_{};
    std::vector<const char*> extensions_;
    VkDeviceCreateInfo deviceInfo_{};  // leads to both; without queues
    bool overlaps_ = true;
    VkBuffer pictureBuffer_ = VK_NULL_HANDLE;  // of the latest copyPicture
    VkDeviceMemory pictureMemory_ = VK_NULL_HANDLE;
    void* pictureBytes_ = nullptr;
    uint32_t validationMessages_ = 0;
};

}  // namespace sample
