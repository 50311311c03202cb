#pragma once

#include <espalier/espalier.h>
#include <vulkan/vulkan.h>

#include <QQuickView>
#include <QVulkanInstance>
#include <QtQuick3D/QQuick3DGeometry>

// What fails ends the program with Espalier's message. All on the thread that draws.
EspHostDevice makeDevice(QVulkanInstance& instance);
void grow(const EspHostDevice& host, const char* surface, const char* grammar);
void fill(QQuick3DGeometry& caster);                          // with the ivy's triangles
void prepare(QQuickView& view, int samples, float exposure);  // before the window's pass
void record(QQuickWindow& window);                            // within it
void uproot(const EspHostDevice& host);                       // and destroy the device
