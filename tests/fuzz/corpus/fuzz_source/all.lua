-- param { "comment", 1 }
local a <const> = param { "a", -1.5e-3, min = 0, ["max"] = 0x1p4, help = [==[ } ]] ]==], words = { 'x', "y\"" }; }
local b = param({ "b", function(t) if t then return 1, 2 end return t end, last = true }) --[[ long
comment ]] local c, d = param { "c", {1, 2} }, x:param("name", { steps = 64, 2 })
for i = 1, 2 do local e = param { "e" .. i, f { 1 }[1] == 2 and 3 or #t } end
local f = param {
  "f", -- first
  a >= b,
}
