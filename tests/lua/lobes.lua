-- Lobes of scattering: numbers, parameters, curves and functions of time.
-- expect params: 1
local fx = effect { name = "lobes" }
local forward = param { "forward", 0.8, min = 0, max = 0.95 }
local smoke = sphere { radius = 1, falloff = 0.5 }

local plain = march { density = smoke, lobes = { {2, 0.8}, {1, -0.3} } }
local four  = march { density = smoke, lobes = { {1, 0}, {1, 0.1}, {1, 0.2}, {1, 0.3} } }
local moves = march {
  density = smoke,
  lobes = { {curve { {0, 1}, {2, 3} }, forward}, {1, function(t) return -0.1 * t end} },
}
local lit   = lighting { density = smoke, lobes = { {1, forward} } }
local taken = march { from = lit }

-- What is wrong says so, and where.
local function refused(lobes, why)
  local settings = { density = smoke, lobes = lobes, lobe_weights = why == "give either" and {1, 0, 0, 0} or nil }
  local ok, message = pcall(march, settings)
  assert(not ok and message:find("march: 'lobes' takes 1 to 4 pairs", 1, true) and message:find(why, 1, true), message)
  assert(settings.lobes == lobes) -- the table of the caller is left alone
end
refused(0.5, "got a number")
refused({}, "got 0 of them")
refused({ {1, 0}, {1, 0}, {1, 0}, {1, 0}, {1, 0} }, "got 5 of them")
refused({ {1, 0}, {1} }, "number 2 is none")
refused({ {1, "forward"} }, "number 1 is none")
refused({ {1, 0} }, "give either")

fx.output = over(over(plain, four), over(moves, taken))
return fx
