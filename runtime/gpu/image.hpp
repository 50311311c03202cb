#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/gpu/device.hpp"
#include "runtime/gpu/owned.hpp"

namespace espalier {

// What an image is used for next; Commands::transition brings it there.
enum class ImageState { undefined, sampled, storage, colorTarget, depthTarget, copySource, copyTarget };

struct ImageDesc {
    std::string_view name;
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    uint32_t width = 1;
    uint32_t height = 1;
    uint32_t layers = 1;  // > 1, or `array`: its view is a 2D array
    uint32_t levels = 1;  // 0: a full mip chain
    uint32_t samples = 1;
    bool array = false;
    // Of sampled, storage, colour and depth attachment; copies are always allowed.
    VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT;
};

// A named 2D image or array, device-local. Contents are undefined at first.
class Image {
  public:
    Image() = default;
    // Fails when memory has run out, or the device can't do that size (content may ask for it).
    static Result<Image> create(Device& device, const ImageDesc& desc);
    // An image that somebody else owns (a host's); only the view is ours.
    static Result<Image> wrap(Device& device, const ImageDesc& desc, VkImage image);

    VkImage handle() const { return handle_; }
    VkImageView view() const { return view_.get(); }  // all levels and layers
    VkFormat format() const { return format_; }
    VkExtent2D extent() const { return extent_; }
    uint32_t layers() const { return layers_; }
    uint32_t levels() const { return levels_; }
    const std::string& name() const { return name_; }
    explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

    // Where the recorded commands leave it. Kept by Commands; set it when a host has changed it.
    ImageState state = ImageState::undefined;

  private:
    static Result<Image> finish(Device& device, const ImageDesc& desc, Image image);

    Owned<MemoryBlock> memory_;
    Owned<VkImage> image_;
    VkImage handle_ = VK_NULL_HANDLE;
    Owned<VkImageView> view_;
    VkFormat format_ = VK_FORMAT_UNDEFINED;
    VkExtent2D extent_{};
    uint32_t layers_ = 1;
    uint32_t levels_ = 1;
    std::string name_;
};

bool isDepthFormat(VkFormat format);
bool hasStencil(VkFormat format);  // views of ours show such an image's depth
// Bytes of one texel of the uncompressed formats that we copy; asserts for others.
uint32_t texelBytes(VkFormat format);

struct SamplerDesc {
    std::string_view name;
    VkFilter filter = VK_FILTER_LINEAR;
    VkSamplerAddressMode address = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    VkSamplerAddressMode addressV = VK_SAMPLER_ADDRESS_MODE_MAX_ENUM;  // as `address`
    bool mips = true;
    bool blendMips = true;       // else the nearer of two
    float anisotropy = 1;        // limited to what the device has
    bool shadowCompare = false;  // for sampler2DShadow: compares LESS_OR_EQUAL
};

class Sampler {
  public:
    Sampler() = default;
    static Result<Sampler> create(Device& device, const SamplerDesc& desc);
    VkSampler handle() const { return sampler_.get(); }

  private:
    Owned<VkSampler> sampler_;
};

// Uploads layer by layer (tightly packed texels of level 0), makes the mips, leaves it `sampled`. For loading.
Status fillImage(Device& device, Image& image, std::span<const std::byte> texels);

// Waits for all submitted work; level 0 of a layer, rows top down, tightly packed. The image keeps its state.
Result<std::vector<std::byte>> readImage(Device& device, Image& image, uint32_t layer = 0);

}  // namespace espalier
