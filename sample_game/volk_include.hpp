#pragma once

// volk loads Vulkan's functions at run time, so that the program can say why when there is no driver. Nothing that
// is linked may call vk... through the loader library: volk's function pointers have the same names.
#define VK_NO_PROTOTYPES
#include <volk.h>
