#pragma once

#include <sys/stat.h>

#include <memory>
#include <string>

namespace espalier::scene {

// A file as it was when it was opened, whatever has taken its place since.
class KeptFile {
  public:
    // Null if it can't be opened.
    static std::shared_ptr<const KeptFile> open(const std::string& path);
    ~KeptFile();
    KeptFile(const KeptFile&) = delete;
    // False: it can't be read, or was written into since.
    bool read(std::string& bytes) const;
    // Whether this is the file that is there by that name now, and nothing was written into it since.
    bool isStill(const std::string& path) const;

  private:
    struct Stamp {
        dev_t device = 0;
        ino_t inode = 0;
        off_t size = -1;
        time_t seconds = 0;
        long nanoseconds = 0;
        bool operator==(const Stamp&) const = default;
    };
    explicit KeptFile(int file) : file_(file), stamp_(stamp()) {}
    static Stamp stampOf(const struct stat& file);
    Stamp stamp() const;

    int file_;
    Stamp stamp_;
};

}  // namespace espalier::scene
