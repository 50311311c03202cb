#include "runtime/run/hazards.hpp"

namespace espalier {

Hazards::Wait Hazards::add(const Kernel& kernel, const Groups& groups) {
    const Things touched = kernel.reads | kernel.writes | groups.thing;
    const bool compute = (touched & written_) != 0 || (kernel.writes & read_) != 0;
    const bool indirect = (kernel.writes & asked_) != 0;
    Wait wait{sent_ || compute || indirect, Use(0)};
    if (sent_) wait.before = wait.before | Use::transfer;
    if (compute || indirect) wait.before = wait.before | Use::compute;
    if (indirect) wait.before = wait.before | Use::indirect;
    if (wait.any) *this = {};
    written_ |= kernel.writes;
    read_ |= kernel.reads;
    asked_ |= groups.thing;
    return wait;
}

}  // namespace espalier
