local fx = effect { name = "a" }
function fx.update(t, dt) local x = t / dt end
fx.output = final { march { density = sphere {} } }.color
return fx
