// In: a PNG's bytes. Out: its texels. libpng leaves by longjmp: what has to be destroyed lives outside of the functions
// that it may leave.
#include <png.h>

#include <cstdlib>
#include <cstring>
#include <iterator>
#include <new>

#include "runtime/surface/picture_codecs.hpp"

namespace espalier {
namespace {

// What decides how colours are shown, and texts: nothing that texels are read by. Not looked into at all.
constexpr const char kPassedOver[] =
    "bKGD\0cHRM\0eXIf\0gAMA\0hIST\0iCCP\0iTXt\0oFFs\0pCAL\0sBIT\0sCAL\0sPLT\0sRGB\0tEXt\0tIME\0zTXt";

class PngReader {
  public:
    explicit PngReader(std::span<const std::byte> bytes) : rest_(bytes) {
        png_ = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, this, noteError, passOver, this, take, give);
        if (png_) info_ = png_create_info_struct(png_);
        if (!info_) {
            png_destroy_read_struct(&png_, &info_, nullptr);
            throw std::bad_alloc();
        }
    }
    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngReader(const PngReader&) = delete;

    // What a step of reading says; false where the library has left it.
    bool done(bool step, std::string& why) const {
        if (!step && starved_) throw std::bad_alloc();
        if (!step) why = why_;
        return step;
    }
    bool readHeader() {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_set_read_fn(png_, this, read);
        png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, reinterpret_cast<png_const_bytep>(kPassedOver),
                                    int(sizeof kPassedOver / 5));
        png_set_crc_action(png_, PNG_CRC_QUIET_USE, PNG_CRC_QUIET_USE);
        png_set_option(png_, PNG_IGNORE_ADLER32, PNG_OPTION_ON);
        png_read_info(png_, info_);
        return true;
    }
    bool askForRgba() {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_set_expand(png_);
        png_set_strip_16(png_);
        png_set_gray_to_rgb(png_);
        png_set_add_alpha(png_, 0xFF, PNG_FILLER_AFTER);
        return update();
    }
    // Grey, or red, green and blue, of 16 bits.
    bool askForGrey() {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_set_expand_16(png_);
        png_set_strip_alpha(png_);
        png_set_swap(png_);  // to this machine's order
        return update();
    }
    bool readRows(png_bytepp rows) {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_read_image(png_, rows);
        return true;
    }
    PictureSides sides() const { return {png_get_image_width(png_, info_), png_get_image_height(png_, info_)}; }
    size_t rowBytes() const { return png_get_rowbytes(png_, info_); }
    uint32_t channels() const { return png_get_channels(png_, info_); }

  private:
    bool update() {
        png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        return true;
    }
    static void noteError(png_structp png, png_const_charp message) {
        auto* self = static_cast<PngReader*>(png_get_error_ptr(png));
        std::strncpy(self->why_, message, sizeof self->why_ - 1);
        png_longjmp(png, 1);
    }
    static void passOver(png_structp, png_const_charp) {}
    static void read(png_structp png, png_bytep out, size_t size) {
        auto* self = static_cast<PngReader*>(png_get_io_ptr(png));
        if (size > self->rest_.size()) png_error(png, "it is cut off");
        std::memcpy(out, self->rest_.data(), size);
        self->rest_ = self->rest_.subspan(size);
    }
    static png_voidp take(png_structp png, png_alloc_size_t size) {
        void* memory = std::malloc(size);
        if (!memory) static_cast<PngReader*>(png_get_mem_ptr(png))->starved_ = true;
        return memory;
    }
    static void give(png_structp, png_voidp memory) { std::free(memory); }

    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    std::span<const std::byte> rest_;
    char why_[96] = {};
    bool starved_ = false;
};

// All rows, as the reader was asked for them.
template <class T>
bool readTexels(PngReader& reader, std::vector<T>& texels, std::string& why) {
    const PictureSides sides = reader.sides();
    texels.resize(size_t(sides.height) * (reader.rowBytes() / sizeof(T)));
    std::vector<png_bytep> rows(sides.height);
    for (size_t y = 0; y < rows.size(); ++y)
        rows[y] = reinterpret_cast<png_bytep>(texels.data()) + y * reader.rowBytes();
    return reader.done(reader.readRows(rows.data()), why);
}

}  // namespace

bool decodePng(std::span<const std::byte> bytes, std::vector<uint8_t>& rgba, std::string& why) {
    PngReader reader(bytes);
    return reader.done(reader.readHeader() && reader.askForRgba(), why) && readTexels(reader, rgba, why);
}

bool decodePng(std::span<const std::byte> bytes, std::vector<uint16_t>& grey, std::string& why) {
    PngReader reader(bytes);
    if (!reader.done(reader.readHeader() && reader.askForGrey(), why) || !readTexels(reader, grey, why)) return false;
    if (reader.channels() != 3) return true;
    const size_t texels = grey.size() / 3;
    for (size_t i = 0; i < texels; ++i) grey[i] = uint16_t(greyOf(grey[3 * i], grey[3 * i + 1], grey[3 * i + 2]));
    grey.resize(texels);
    return true;
}

}  // namespace espalier
