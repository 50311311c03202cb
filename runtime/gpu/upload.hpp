#pragma once

// Bytes on their way into new buffers and images, in steps. Planning and filling need no thread of the device's, so a
// file can be loaded beside frames; the other steps are short.

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/gpu/buffer.hpp"
#include "runtime/gpu/image.hpp"

namespace espalier {

class Upload {
  public:
    // 1. Any thread. What is returned names the buffer or image to the take functions.
    size_t addBuffer(std::string name, std::vector<std::byte> bytes);
    template <class T>
    size_t addBuffer(std::string name, const std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        const auto bytes = std::as_bytes(std::span(values));
        return addBuffer(std::move(name), std::vector<std::byte>(bytes.begin(), bytes.end()));
    }
    // A sampled image with all its mips; texels: tightly packed, of level 0.
    size_t addImage(std::string name, VkFormat format, uint32_t width, uint32_t height, std::vector<std::byte> texels);

    // 2. The device's thread: takes memory. Fails where it has run out; then nothing is held.
    Status allocate(Device& device);
    // 3. Any thread: copies the bytes to where the device finds them, and lets go of them.
    void fill();
    // 4. The device's thread: submits what is left to do, and doesn't wait. What is submitted later sees all of it.
    Status submit(Device& device);
    // 5. Once each.
    Buffer takeBuffer(size_t index) { return std::move(buffers_[index].buffer); }
    Image takeImage(size_t index) { return std::move(images_[index].image); }

    // All steps but the last, at once.
    Status run(Device& device);

    uint64_t bytes() const { return bytes_; }  // of the device, about, that all of it takes

  private:
    struct ToBuffer {
        std::string name;
        std::vector<std::byte> bytes;
        Buffer buffer, staging;  // no staging where the buffer is mapped
    };
    struct ToImage {
        std::string name;
        VkFormat format;
        uint32_t width, height;
        std::vector<std::byte> bytes;
        Image image;
        Buffer staging;
    };
    Status allocate(Device& device, ToBuffer& to);
    Status allocate(Device& device, ToImage& to);

    std::vector<ToBuffer> buffers_;
    std::vector<ToImage> images_;
    uint64_t bytes_ = 0;
};

}  // namespace espalier
