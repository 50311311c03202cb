#pragma once

#include <string>
#include <vector>

#include "plugin_api/espalier.h"

namespace espalier {

// A host's device whose driver fails on order: Espalier asks for its functions through the table of EspHostDevice,
// and gets every function that can fail as one that counts its calls and, at the call asked for, fails.
class FailingDevice {
  public:
    enum class Failure {
        OutOfMemory,   // one call gives VK_ERROR_OUT_OF_DEVICE_MEMORY and does nothing; later calls are as ever
        Full,          // the GPU's memory is all taken: no call of vkAllocateMemory works from now on
        Lost,          // this call and all after it give VK_ERROR_DEVICE_LOST, as after a crash of the GPU
        LostAtSubmit,  // likewise, and only submissions count
        Odd,           // see answerOddly
    };

    FailingDevice();
    ~FailingDevice();  // after espDestroy
    FailingDevice(const FailingDevice&) = delete;

    EspHostDevice host() const;

    // Fails the call number `at` from now on (0: the next one; without meaning for Full). Counts from 0 again.
    void failAt(uint32_t at, Failure how);
    // The call number `at` from now on of this function gives `result`, a VkResult that needn't be one, and does
    // nothing; calls of other functions, and later ones, are as ever. function: a string literal.
    void answerOddly(const char* function, uint32_t at, int result);
    // The functions that can fail.
    static std::vector<const char*> functions();
    // Nothing fails any more.
    void heal();
    // Another device of the same GPU, and nothing fails on it; host() is of that one from now on. The one before lives
    // until dropOld().
    void renew();
    void dropOld();
    // What is submitted has been done when the call returns, as on a fast GPU, or not before long.
    void finishAtOnce(bool does);
    // Calls since the last failAt or heal that could have failed in the way last asked for.
    uint32_t calls() const;
    // The function that failed, or an empty text if none has.
    std::string failed() const;

  private:
    static void makeDevice();
};

}  // namespace espalier
