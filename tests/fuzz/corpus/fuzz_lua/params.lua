-- set: amount=4
-- set: tint=#00ff00
-- set: look=hard
-- expect params: 5
local function near() return true end
local fx = effect { name = "params" }
local amount = param { "amount", 1, min = 0, max = 10, unit = "m", help = "how much" }
local tint = param { "tint", "#ffffff" }
local look = param { "look", "soft", words = { "soft", "hard" } }
local on = param { "on", true }
local count = param { "count", 3, integer = true }

assert(amount:get() == 4 and look:get() == "hard" and on:get() == true and count:get() == 3)
assert(near(tint:get(), { 0, 1, 0 }))

amount:set(2)
look:set("soft")
on:set(false)
tint:set { 1, 0, 0 }
assert(amount:get() == 2 and look:get() == "soft" and on:get() == false)
assert(near(tint:get(), { 1, 0, 0 }))
assert(not pcall(amount.set, amount, 11) and not pcall(look.set, look, "loud"))

fx.update = function(t, dt) amount:set(t + dt) end
fx.output = geometry {}
