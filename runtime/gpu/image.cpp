// Images, views and samplers; loading and reading back outside of frames.
#include "runtime/gpu/image.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "runtime/core/check.hpp"
#include "runtime/gpu/commands.hpp"

namespace espalier {
namespace {

VkImageAspectFlags aspectOf(VkFormat format) {
    return isDepthFormat(format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

Result<Owned<VkImageView>> makeView(Device& device, const ImageDesc& desc, VkImage image, VkImageViewType type,
                                    const VkImageSubresourceRange& range) {
    VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    info.image = image;
    info.viewType = type;
    info.format = desc.format;
    info.subresourceRange = range;
    VkImageView view = VK_NULL_HANDLE;
    if (!device.succeeded(device.vk().vkCreateImageView(device.handle(), &info, nullptr, &view)))
        return gpuFailure(device, desc.name, "making its view");
    device.setName(VK_OBJECT_TYPE_IMAGE_VIEW, uint64_t(view), desc.name);
    return Owned(device, view);
}

}  // namespace

bool isDepthFormat(VkFormat format) {
    return format == VK_FORMAT_D16_UNORM || format == VK_FORMAT_D32_SFLOAT || format == VK_FORMAT_X8_D24_UNORM_PACK32 ||
           hasStencil(format);
}

bool hasStencil(VkFormat format) {
    return format == VK_FORMAT_D24_UNORM_S8_UINT || format == VK_FORMAT_D32_SFLOAT_S8_UINT;
}

uint32_t texelBytes(VkFormat format) {
    switch (format) {
        case VK_FORMAT_R8_UNORM:
            return 1;
        case VK_FORMAT_R8G8_UNORM:
        case VK_FORMAT_R16_UNORM:
        case VK_FORMAT_R16_SFLOAT:
        case VK_FORMAT_D16_UNORM:
            return 2;
        case VK_FORMAT_R8G8B8A8_UNORM:
        case VK_FORMAT_R8G8B8A8_SRGB:
        case VK_FORMAT_B8G8R8A8_UNORM:
        case VK_FORMAT_B8G8R8A8_SRGB:
        case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
        case VK_FORMAT_B10G11R11_UFLOAT_PACK32:
        case VK_FORMAT_R16G16_SFLOAT:
        case VK_FORMAT_R16G16_SNORM:
        case VK_FORMAT_R32_UINT:
        case VK_FORMAT_R32_SFLOAT:
        case VK_FORMAT_D32_SFLOAT:
            return 4;
        case VK_FORMAT_R16G16B16A16_SFLOAT:
        case VK_FORMAT_R16G16B16A16_UNORM:
        case VK_FORMAT_R32G32_UINT:
        case VK_FORMAT_R32G32_SFLOAT:
            return 8;
        case VK_FORMAT_R32G32B32A32_UINT:
        case VK_FORMAT_R32G32B32A32_SFLOAT:
            return 16;
        default:
            fatal("texelBytes: unknown format " + std::to_string(int(format)));
    }
}

Result<Image> Image::create(Device& device, const ImageDesc& desc) {
    require(desc.width && desc.height && desc.layers, "an image has at least one texel");
    const VkPhysicalDeviceLimits& limits = device.info().limits;
    if (std::max(desc.width, desc.height) > limits.maxImageDimension2D || desc.layers > limits.maxImageArrayLayers)
        return deviceFailure(desc.name, "an image of " + std::to_string(desc.width) + "x" +
                                            std::to_string(desc.height) + "x" + std::to_string(desc.layers) +
                                            " is larger than the GPU allows (" +
                                            std::to_string(limits.maxImageDimension2D) + ", layers " +
                                            std::to_string(limits.maxImageArrayLayers) + ")");
    const uint32_t fullChain = uint32_t(std::bit_width(std::max(desc.width, desc.height)));
    Image image;
    image.levels_ = desc.levels ? std::min(desc.levels, fullChain) : fullChain;
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = desc.format;
    info.extent = {desc.width, desc.height, 1};
    info.mipLevels = image.levels_;
    info.arrayLayers = desc.layers;
    info.samples = VkSampleCountFlagBits(desc.samples);
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = desc.usage;
    if (desc.samples == 1) info.usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    VkImage handle = VK_NULL_HANDLE;
    if (!device.succeeded(device.vk().vkCreateImage(device.handle(), &info, nullptr, &handle)))
        return gpuFailure(device, desc.name, "making an image");
    image.image_ = Owned(device, handle);
    image.handle_ = handle;
    device.setName(VK_OBJECT_TYPE_IMAGE, uint64_t(handle), desc.name);

    const std::string name(desc.name);
    MemoryRequest request{{}, BufferUse::device, true, name.c_str()};
    device.vk().vkGetImageMemoryRequirements(device.handle(), handle, &request.requirements);
    Result<MemoryBlock> block = device.memory().allocate(request);
    if (!block && device.retiredCount() > 0 && device.waitIdle()) block = device.memory().allocate(request);
    if (!block) return block.failure();
    image.memory_ = Owned(device, *block);
    if (!device.succeeded(device.vk().vkBindImageMemory(device.handle(), handle, block->memory, block->offset)))
        return gpuFailure(device, desc.name, "binding its memory");
    return finish(device, desc, std::move(image));
}

Result<Image> Image::wrap(Device& device, const ImageDesc& desc, VkImage handle) {
    Image image;
    image.handle_ = handle;
    image.levels_ = desc.levels;
    return finish(device, desc, std::move(image));
}

Result<Image> Image::finish(Device& device, const ImageDesc& desc, Image image) {
    image.name_ = desc.name;
    image.format_ = desc.format;
    image.extent_ = {desc.width, desc.height};
    image.layers_ = desc.layers;
    const VkImageAspectFlags aspect = aspectOf(desc.format);
    const bool array = desc.array || desc.layers > 1;
    Result<Owned<VkImageView>> whole =
        makeView(device, desc, image.handle_, array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D,
                 {aspect, 0, image.levels_, 0, desc.layers});
    if (!whole) return whole.failure();
    image.view_ = std::move(*whole);
    return image;
}

Result<Sampler> Sampler::create(Device& device, const SamplerDesc& desc) {
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.magFilter = info.minFilter = desc.filter;
    info.mipmapMode = desc.filter == VK_FILTER_LINEAR && desc.blendMips ? VK_SAMPLER_MIPMAP_MODE_LINEAR
                                                                        : VK_SAMPLER_MIPMAP_MODE_NEAREST;
    info.addressModeU = info.addressModeV = info.addressModeW = desc.address;
    if (desc.addressV != VK_SAMPLER_ADDRESS_MODE_MAX_ENUM) info.addressModeV = desc.addressV;
    info.maxLod = desc.mips ? VK_LOD_CLAMP_NONE : 0;
    info.maxAnisotropy = std::min(desc.anisotropy, device.info().maxAnisotropy);
    info.anisotropyEnable = info.maxAnisotropy > 1;
    info.compareEnable = desc.shadowCompare;
    info.compareOp = desc.shadowCompare ? VK_COMPARE_OP_LESS_OR_EQUAL : VK_COMPARE_OP_ALWAYS;
    info.borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE;
    VkSampler handle = VK_NULL_HANDLE;
    if (!device.succeeded(device.vk().vkCreateSampler(device.handle(), &info, nullptr, &handle)))
        return gpuFailure(device, desc.name, "making a sampler");
    device.setName(VK_OBJECT_TYPE_SAMPLER, uint64_t(handle), desc.name);
    Sampler sampler;
    sampler.sampler_ = Owned(device, handle);
    return sampler;
}

Status fillImage(Device& device, Image& image, std::span<const std::byte> texels) {
    const uint64_t layerBytes = uint64_t(image.extent().width) * image.extent().height * texelBytes(image.format());
    requireEqual(uint64_t(texels.size()), layerBytes * image.layers(), "fillImage: bytes of " + image.name());
    Result<Buffer> staging = Buffer::create(device, "image upload", texels.size(), BufferUse::upload);
    if (!staging) return staging.failure();
    std::memcpy(staging->mapped(), texels.data(), texels.size());
    Result<Commands> commands = Commands::begin(device, "image upload");
    if (!commands) return commands.failure();
    commands->transition(image, ImageState::copyTarget, true);
    for (uint32_t layer = 0; layer < image.layers(); ++layer)
        commands->copyToImage(*staging, layer * layerBytes, image, 0, layer);
    commands->makeMips(image);
    return commands->finish();
}

Result<std::vector<std::byte>> readImage(Device& device, Image& image, uint32_t layer) {
    require(image.state != ImageState::undefined, "readImage: nothing has been drawn into the image");
    const uint64_t size = uint64_t(image.extent().width) * image.extent().height * texelBytes(image.format());
    Result<Buffer> staging = Buffer::create(device, "read back", size, BufferUse::readback);
    if (!staging) return staging.failure();
    Result<Commands> commands = Commands::begin(device, "read back");
    if (!commands) return commands.failure();
    const ImageState before = image.state;
    commands->transition(image, ImageState::copySource);
    commands->copyFromImage(image, *staging, 0, 0, layer);
    commands->transition(image, before);
    if (Status done = commands->finish(); !done) return done.failure();
    return std::vector<std::byte>(staging->mapped(), staging->mapped() + size);
}

}  // namespace espalier
