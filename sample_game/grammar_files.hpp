#pragma once

#include <string>
#include <vector>

#include "sample_game/file_watch.hpp"
#include "tools/scene/scene.hpp"

namespace sample {

// What other programs write into the grammars' files while these are open.
class GrammarFiles {
  public:
    struct Change {
        uint32_t grammar = 0;
        std::string text;       // that it is to have: the file's, or its own again if only what it includes has changed
        bool replaces = false;  // what was typed and isn't in the file
    };

    // Files as they are now count as seen; where one was written since `read`, when the scene began to be read, what
    // the scene has of them does.
    void begin(const espalier::scene::Scene& scene, std::filesystem::file_time_type read = kNeverWritten);
    // Since begin() or the last call. A file that can't be read counts as it was.
    std::vector<Change> look(const espalier::scene::Scene& scene);
    // Written from here, and no news whatever becomes of the grammar until the next look. What else reads the file is
    // told of it then.
    void wrote(const espalier::scene::Scene& scene, uint32_t grammar, const std::string& text);

    // What a grammar includes, each file once.
    struct Included {
        std::string text;                // of all of them
        std::vector<std::string> names;  // relative to the grammar's folder
    };

  private:
    struct Seen {
        std::vector<FileStamp> stamps;  // of the folder's grammars and of what is included from elsewhere
        std::string text;
        Included included;
    };
    std::vector<Seen> seen_;  // by grammar
};

// The text in a grammar's file, read anew when that has changed.
class FileText {
  public:
    // Null: it can't be read.
    const std::string* of(const std::string& file);

  private:
    std::string file_, text_;
    FileStamp stamp_;
    bool good_ = false;
};

// But for empty lines at the end: a project doesn't keep whether the last line is ended.
bool sameText(const std::string& a, const std::string& b);

// Into the grammar's file, or what a link of its name leads to, whole or not at all.
bool writeGrammar(const std::string& file, const std::string& text, std::string& error);

}  // namespace sample
