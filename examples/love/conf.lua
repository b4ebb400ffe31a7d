-- SPDX-License-Identifier: MIT
function love.conf(t)
  t.identity = "springstep-rope"
  t.version = "11.4"
  t.window.title = "springstep: a rope on the pointer"
  t.window.width, t.window.height = 900, 640
  t.window.msaa = 4
  t.modules.audio, t.modules.sound, t.modules.joystick, t.modules.physics, t.modules.video = false, false, false, false, false
end
