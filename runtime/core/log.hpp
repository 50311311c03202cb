#pragma once

#include <functional>
#include <string_view>

namespace espalier {

enum class Severity { info, warning, error };

// Where messages go; whoever makes a device or a plugin hands one in. May be called from any thread.
using Log = std::function<void(Severity, std::string_view)>;

// One line on stderr a message, "espalier: warning: ...".
Log logToStderr();

}  // namespace espalier
