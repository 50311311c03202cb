#pragma once

#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "runtime/gpu/device.hpp"
#include "runtime/gpu/owned.hpp"

namespace espalier {

// A named piece of GPU memory, reached by address; good as storage, indirect arguments, indices, copy source and
// target. Contents are undefined at first. Size 0 is allowed.
class Buffer {
  public:
    Buffer() = default;
    static Result<Buffer> create(Device& device, std::string_view name, uint64_t sizeBytes,
                                 BufferUse use = BufferUse::device);

    VkBuffer handle() const { return buffer_.get(); }
    uint64_t address() const { return address_; }
    uint64_t size() const { return size_; }
    const std::string& name() const { return name_; }
    // Where the CPU sees it, or null (see BufferUse). Only touch it while the GPU doesn't.
    std::byte* mapped() const { return mapped_; }
    template <class T>
    std::span<T> mappedAs() const {
        return {reinterpret_cast<T*>(mapped_), mapped_ ? size_ / sizeof(T) : 0};
    }
    explicit operator bool() const { return bool(buffer_); }

  private:
    Owned<MemoryBlock> memory_;  // before the buffer, so that it is freed after it
    Owned<VkBuffer> buffer_;
    uint64_t address_ = 0;
    uint64_t size_ = 0;
    std::byte* mapped_ = nullptr;
    std::string name_;
};

// A buffer read as texels of one format by texelFetch: on software devices several times faster than by address, since
// a texel comes in one piece. Fails beyond DeviceInfo::limits.maxTexelBufferElements of them, and when memory has run
// out. The buffer must outlive it.
class TexelView {
  public:
    TexelView() = default;
    static Result<TexelView> create(Device& device, const Buffer& buffer, VkFormat format);
    VkBufferView handle() const { return view_.get(); }
    explicit operator bool() const { return bool(view_); }

  private:
    Owned<VkBufferView> view_;
};

// A device buffer of so many bytes and its view as texels, in place of these. On failure both stay as they were.
Status makeTexels(Device& device, std::string_view name, uint64_t sizeBytes, VkFormat format, Buffer& buffer,
                  TexelView& texels);

// Has at least so many bytes, or is made anew for `use`, without what was in it. On failure it stays as it was.
Status makeAtLeast(Device& device, Buffer& buffer, std::string_view name, uint64_t sizeBytes,
                   BufferUse use = BufferUse::device);

// A device buffer with these bytes in it, ready when the call returns. For loading; inside a frame use
// Commands::upload.
Result<Buffer> makeBuffer(Device& device, std::string_view name, std::span<const std::byte> bytes);
template <class T>
Result<Buffer> makeBuffer(Device& device, std::string_view name, const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    return makeBuffer(device, name, std::as_bytes(std::span(values)));
}

// The buffer from `offset` on as shaders know it. Buf: a struct that BUFFER makes (shaders/shared/language.h).
template <class Buf>
Buf addressOf(const Buffer& buffer, uint64_t offset = 0) {
    return Buf{reinterpret_cast<decltype(Buf::v)>(buffer.address() + offset)};
}

// Waits for all submitted work and returns bytes [offset, offset + sizeBytes) of the buffer.
Result<std::vector<std::byte>> readBuffer(Device& device, const Buffer& buffer, uint64_t offset, uint64_t sizeBytes);
template <class T>
Result<std::vector<T>> readVector(Device& device, const Buffer& buffer, size_t first, size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    Result<std::vector<std::byte>> bytes = readBuffer(device, buffer, first * sizeof(T), count * sizeof(T));
    if (!bytes) return bytes.failure();
    std::vector<T> values(count);
    if (count) std::memcpy(static_cast<void*>(values.data()), bytes->data(), bytes->size());
    return values;
}

}  // namespace espalier
