#pragma once

#include <array>
#include <string_view>

#include "viewer/session/actions.h"

namespace adamas::viewer {

/// A key of the window, and its action.
struct KeyBinding {
  Action action;
  std::string_view key;   ///< GLFW's name: a capital letter, a digit, "Enter", "Space", "Home", "F12"
  std::string_view what;  ///< the action in the words of the help
};

/// All keys, in the order of the help.
inline constexpr std::array<KeyBinding, 33> kKeyBindings{{
    {Action::kViewFront, "1", "View from the front, along y"},
    {Action::kViewRight, "3", "View from the right, against x"},
    {Action::kViewTop, "7", "View from above, against z"},
    {Action::kViewIsometric, "9", "View from a corner"},
    {Action::kProjection, "5", "Orthographic or perspective"},
    {Action::kShowAll, "Enter", "Show all of the data"},
    {Action::kCameraMode, "T", "Trackball, turntable, fly"},
    {Action::kEdges, "E", "Edges of the mesh"},
    {Action::kField, "S", "Next field of colours"},
    {Action::kColourBar, "B", "Colour bar"},
    {Action::kColourMap, "C", "Next colour map"},
    {Action::kAxes, "X", "Axes"},
    {Action::kBox, "G", "Box of the data"},
    {Action::kShading, "L", "Lit, or shaded as a sphere"},
    {Action::kCut, "P", "Plane of a cross section"},
    {Action::kCulledFrom, "O", "Keep the mesh of this view, to look at it from elsewhere"},
    {Action::kHidden, "V", "Leave coarse what the picture hides"},
    {Action::kPanels, "Tab", "Panels"},
    {Action::kHelp, "H", "This help"},
    {Action::kBookmark, "M", "Keep this view as a bookmark"},
    {Action::kNextBookmark, "N", "Go to the next bookmark"},
    {Action::kRecord, "R", "Begin or end recording the camera's path"},
    {Action::kPlay, "Space", "Play the steps of a series, or the camera"},
    {Action::kPlayCamera, "A", "Play the recorded path, or turn"},
    {Action::kPreviousStep, ",", "The step before"},
    {Action::kNextStep, ".", "The next step"},
    {Action::kFirstStep, "Home", "The first step"},
    {Action::kLastStep, "End", "The last step"},
    {Action::kTime, "D", "Time of the step"},
    {Action::kExportFilm, "F", "Write the steps as a film; Escape stops it"},
    {Action::kExportFrames, "I", "Write the steps as images"},
    {Action::kScreenshot, "F12", "Screenshot"},
    {Action::kQuit, "Escape", "End"},
}};

}  // namespace adamas::viewer
