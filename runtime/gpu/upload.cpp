// Enters: bytes. Leaves: buffers and images that hold them, in steps that a load beside frames takes one by one.
#include "runtime/gpu/upload.hpp"

#include <cstring>
#include <utility>

#include "runtime/core/check.hpp"
#include "runtime/core/let_go.hpp"
#include "runtime/gpu/commands.hpp"

namespace espalier {
namespace {

void moveInto(const Buffer& buffer, std::vector<std::byte>& bytes) {
    if (!bytes.empty()) std::memcpy(buffer.mapped(), bytes.data(), bytes.size());
    letGo(bytes);
}

}  // namespace

size_t Upload::addBuffer(std::string name, std::vector<std::byte> bytes) {
    bytes_ += bytes.size();
    buffers_.push_back({std::move(name), std::move(bytes), {}, {}});
    return buffers_.size() - 1;
}

size_t Upload::addImage(std::string name, VkFormat format, uint32_t width, uint32_t height,
                        std::vector<std::byte> texels) {
    requireEqual(uint64_t(texels.size()), uint64_t(width) * height * texelBytes(format), "Upload: bytes of " + name);
    bytes_ += texels.size() + texels.size() / 3;  // with its mips
    images_.push_back({std::move(name), format, width, height, std::move(texels), {}, {}});
    return images_.size() - 1;
}

Status Upload::allocate(Device& device, ToBuffer& to) {
    if (Status made = assign(to.buffer, Buffer::create(device, to.name, to.bytes.size())); !made) return made;
    if (to.buffer.mapped() || to.bytes.empty()) return Done{};
    return assign(to.staging, Buffer::create(device, to.name + ", upload", to.bytes.size(), BufferUse::upload));
}

Status Upload::allocate(Device& device, ToImage& to) {
    ImageDesc desc{.name = to.name, .format = to.format, .width = to.width, .height = to.height};
    desc.levels = 0;
    if (Status made = assign(to.image, Image::create(device, desc)); !made) return made;
    return assign(to.staging, Buffer::create(device, to.name + ", upload", to.bytes.size(), BufferUse::upload));
}

Status Upload::allocate(Device& device) {
    Status all = Done{};
    for (ToBuffer& to : buffers_)
        if (all) all = allocate(device, to);
    for (ToImage& to : images_)
        if (all) all = allocate(device, to);
    if (all) return all;
    for (ToBuffer& to : buffers_) to.buffer = {}, to.staging = {};
    for (ToImage& to : images_) to.image = {}, to.staging = {};
    return all;
}

void Upload::fill() {
    for (ToBuffer& to : buffers_) moveInto(to.staging ? to.staging : to.buffer, to.bytes);
    for (ToImage& to : images_) moveInto(to.staging, to.bytes);
}

Status Upload::submit(Device& device) {
    bool any = !images_.empty();
    for (const ToBuffer& to : buffers_) any |= bool(to.staging);
    if (!any) return Done{};
    Result<Commands> commands = Commands::begin(device, "upload");
    if (!commands) return commands.failure();
    for (const ToBuffer& to : buffers_)
        if (to.staging) commands->copy(to.staging, to.buffer, to.buffer.size());
    for (ToImage& to : images_) {
        commands->transition(to.image, ImageState::copyTarget, true);
        commands->copyToImage(to.staging, 0, to.image);
        commands->makeMips(to.image);
    }
    if (Result<uint64_t> submitted = commands->submit(); !submitted) return submitted.failure();
    for (ToBuffer& to : buffers_) to.staging = {};
    for (ToImage& to : images_) to.staging = {};
    return Done{};
}

Status Upload::run(Device& device) {
    if (Status allocated = allocate(device); !allocated) return allocated;
    fill();
    return submit(device);
}

}  // namespace espalier
