-- SPDX-License-Identifier: MIT
function love.conf(t)
  t.identity = "springstep-rope"
  t.version = "11.4"
  t.window.title = "springstep: a rope on the pointer"
  t.window.width, t.window.height = 900, 640
  t.window.msaa = 4
  for _, unused in ipairs {"audio", "joystick", "physics", "sound", "video"} do
    t.modules[unused] = false
  end
end
